// The panel of blocks: shown or not, the cells across a chord, the export of the fine grid.

import { button, node, setText } from "../dom.js";
import { counted } from "../numbers.js";

export class BlocksPanel {
  constructor(card) {
    this._card = card;
    this._on = false;
    this._edge = -1; // a selected edge, whose chord is edited
    this._blocks = null;
    this._asked = -1; // the revision whose blocks were asked for last
    this._make();
    this.root = node("section", "mw-part mw-part-blocks", { "aria-label": "Blocks", hidden: true },
      node("div", "mw-head-line", {}, node("h4", "mw-heading", {}, "Blocks"), this._toggle),
      this._body);
  }

  _make() {
    this._toggle = button("mw-tool mw-tool-text", "Show blocks and the numbers of cells of the grid", {
      text: "Show", act: () => this._turn(!this._on),
    });
    this._toggle.setAttribute("aria-pressed", "false");
    this._words = node("p", "mw-hint mw-blocks-words", { role: "status" });
    this._previous = button("mw-tool", "Previous chord", { text: "\u2039", act: () => this._step(-1) });
    this._next = button("mw-tool", "Next chord", { text: "\u203a", act: () => this._step(1) });
    this._count = node("input", "mw-select mw-count", {
      type: "number", min: 1, max: 100000, step: 1, "aria-label": "Cells across the chord",
      title: "Cells across the selected chord",
    });
    this._count.addEventListener("change", () => this._send(this._count.valueAsNumber));
    this._count.addEventListener("keydown", (event) => {
      if (event.key !== "Enter") return;
      // notebooks have a meaning of their own for it, and the browser then reports no change
      event.preventDefault();
      event.stopPropagation();
      this._send(this._count.valueAsNumber);
    });
    this._auto = button("mw-tool mw-tool-text", "Let size and evenness decide the number of cells", {
      text: "Auto", act: () => this._send(null),
    });
    this._chord = node("div", "mw-chord", {}, this._previous, this._next, this._count, this._auto);
    this._format = node("select", "mw-select mw-format", { "aria-label": "Format of the grid" });
    this._export = button("mw-button", "Make the fine grid, and save it as a file", {
      text: "Export grid", act: () => this._card.request("export_blocks", { ending: this._format.value }),
    });
    this._body = node("div", "mw-blocks", { hidden: true },
      this._words, this._chord, node("div", "mw-buttons", {}, this._format, this._export));
  }

  /** Show the numbers of a head; blocks that are shown are asked for again after a change. */
  update(head) {
    this.root.hidden = this._card.readOnly || head.kind !== "quad" || !head.elements;
    if (this.root.hidden) this._turn(false);
    else if (this._on) this._ask();
  }

  /** Show what Python has sent: lines of the edges, chords, numbers. */
  receive(content, [points, first]) {
    if (!this._on) return;
    const places = new Float32Array(bytesOf(points));
    const begins = new Int32Array(bytesOf(first));
    const lines = content.ends.map((_, edge) => places.subarray(2 * begins[edge], 2 * begins[edge + 1]));
    this._blocks = { ...content, lines };
    this._fillFormats(content.formats);
    if (this._edge >= content.ends.length) this._edge = -1;
    this._show();
  }

  /** Select the chord of an edge; `editing`: put the keyboard into its number. */
  select(edge, editing = false) {
    this._edge = edge;
    this._show();
    if (!editing) return;
    this._count.focus({ preventScroll: true });
    this._count.select();
  }

  /** Keep a file that Python has made: the browser asks where, or downloads it. */
  keep({ name }, [data]) {
    const address = URL.createObjectURL(new Blob([data], { type: "application/octet-stream" }));
    const link = node("a", "", { href: address, download: name });
    this.root.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(address), 60000);
  }

  _turn(on) {
    if (on === this._on) return;
    this._on = on;
    this._toggle.setAttribute("aria-pressed", String(on));
    this._body.hidden = !on;
    this._asked = this._edge = -1;
    this._blocks = null;
    this._show();
    if (on) this._ask();
  }

  _ask() {
    const { revision } = this._card.replica;
    if (revision === this._asked) return;
    this._asked = revision;
    this._card.request("blocks");
  }

  _send(count) {
    if (!this._blocks || this._edge < 0 || Number.isNaN(count)) return;
    const { chord, counts, set } = this._blocks;
    const own = chord[this._edge];
    if (set.includes(own) && counts && counts[own] === count) return;
    this._card.request("chord_count", { ends: this._blocks.ends[this._edge], count });
    this._asked = -1; // a refusal leaves the revision as it is, and the field shows what holds
  }

  /** Select the next or the previous chord. */
  _step(step) {
    if (!this._blocks) return;
    const { chord } = this._blocks;
    const count = 1 + Math.max(...chord);
    const now = this._edge < 0 ? (step > 0 ? -1 : 0) : chord[this._edge];
    this.select(chord.indexOf((now + step + count) % count));
  }

  _show() {
    const { stage } = this._card;
    const blocks = this._blocks;
    const chord = blocks && this._edge >= 0 ? blocks.chord[this._edge] : -1;
    Object.assign(stage.shown, { blocks, chord });
    stage.repaint();
    if (!blocks) {
      setText(this._words, this._on ? "Blocks are being found\u2026" : "");
      return;
    }
    const cells = blocks.counts ? `, ${counted(blocks.cells, "cell")}` : "";
    setText(this._words, blocks.problem || `${counted(blocks.quads, "quad")}${cells}. ${
      chord < 0 ? "Click a number to change it." : `Chord ${chord}${
        blocks.set.includes(chord) ? ", set by hand." : "."}`}`);
    const known = chord >= 0 && blocks.counts;
    this._count.value = known ? blocks.counts[chord] : "";
    this._count.disabled = chord < 0;
    this._auto.disabled = chord < 0 || !blocks.set.includes(chord);
    this._export.disabled = !blocks.counts;
  }

  _fillFormats(formats) {
    if (this._format.childElementCount === formats.length) return;
    this._format.replaceChildren(...formats.map(([ending, title]) => (
      node("option", "", { value: ending }, ending.startsWith(".") ? `${title} (${ending})` : title))));
  }
}

/** A copy of a message's array, which may be a view that is not aligned. */
function bytesOf(view) {
  const start = view.byteOffset || 0;
  return (view.buffer || view).slice(start, start + view.byteLength);
}
