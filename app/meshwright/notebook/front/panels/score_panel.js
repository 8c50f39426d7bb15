// The panel of the score: score and optimum, counts of the mesh, undo, redo and smoothing.

import { button, icon, node, setText } from "../dom.js";
import { clamp, counted } from "../numbers.js";

export class ScorePanel {
  constructor(card) {
    this._card = card;
    this._number = node("div", "mw-score-number");
    this._goal = node("div", "mw-score-goal");
    this._gap = node("div", "mw-score-gap");
    this._bar = node("div", "mw-bar-done");
    this._barBox = node("div", "mw-bar", {
      role: "progressbar", "aria-label": "Progress from the start to the optimum",
      "aria-valuemin": "0", "aria-valuemax": "100",
      title: "Normalised return: (s at the start \u2212 s) / (s at the start \u2212 optimum)",
    }, this._bar);
    this._optimalTitle = node("div", "mw-optimal-title");
    this._findings = node("div", "mw-optimal-text");
    this._optimal = node("div", "mw-optimal", {
      hidden: true, title: "s = s*: no connectivity is better under these desired degrees.",
    }, this._optimalTitle, this._findings);
    this._summary = node("div", "mw-score-words", {}, this._goal, this._gap);
    this._facts = node("dl", "mw-facts");
    this._shape = this._fact("Shape");
    this._shape.parentElement.title = "Worst scaled Jacobian, the smallest sine of a corner, and what "
      + "the angles of the corners permit where they are regular";
    this._flattest = this._fact("Worst element shape");
    this._flattest.parentElement.title = "Worst corner of an element by angle and ratio of sides";
    this._irregular = this._fact("Irregular vertices");
    this._elements = this._fact("Elements");
    this._blocks = this._fact("Blocks, each a regular grid");
    this._inverted = this._fact("Inverted elements");
    this._makeSteps();
    this.root = node("section", "mw-part mw-part-score", { "aria-label": "Score" },
      node("h4", "mw-heading", {}, "Score"),
      node("div", "mw-score", {}, this._number, this._summary, this._optimal),
      this._barBox, this._facts, card.colourChoice.root, this._steps);
  }

  /** Show the numbers of a head. */
  update(head) {
    const solved = head.at_optimum;
    setText(this._number, head.score.toLocaleString("en"));
    this._number.setAttribute("aria-label", `Score ${head.score}, optimum ${head.optimum}`);
    this._number.title = "s: the sum of |degree \u2212 desired degree| over all vertices";
    setText(this._goal, `Optimum ${head.optimum.toLocaleString("en")}`);
    const gap = head.score - head.optimum;
    const distance = Math.abs(gap).toLocaleString("en");
    setText(this._gap, gap < 0 ? `${distance} below it: no valid mesh is` : `${distance} above it`);
    this._optimal.hidden = !solved;
    this._summary.hidden = solved;
    const share = solved ? 1 : clamp(head.return, 0, 1);
    this._bar.style.width = `${100 * share}%`;
    this._barBox.setAttribute("aria-valuenow", String(Math.round(100 * share)));
    const [count, all] = [head.irregular, head.vertices].map((n) => n.toLocaleString("en"));
    setText(this._irregular, `${count} of ${all}`);
    setText(this._elements, counted(head.elements, head.kind === "quad" ? "quad" : "triangle"));
    setText(this._blocks, head.blocks === null ? "" : head.blocks.toLocaleString("en"));
    this._blocks.parentElement.hidden = head.blocks === null;
    setText(this._inverted, head.inverted.toLocaleString("en"));
    this._inverted.parentElement.hidden = !head.inverted;
    this._updateShape(head);
    this._updateSteps(head);
  }

  _updateShape({ shape, findings, at_optimum: solved }) {
    setText(this._shape, shape ? shape.words : "\u2013");
    setText(this._flattest, shape ? shape.flattest : "\u2013");
    if (!solved || !shape) return;
    const fine = findings.every(([, inOrder]) => inOrder);
    this._optimal.classList.toggle("mw-optimal-warns", !fine);
    this._optimalTitle.replaceChildren(icon(fine ? "check" : "alert", 16), "Optimal connectivity");
    this._findings.replaceChildren(...findings.map(([text, inOrder]) => (
      node("div", inOrder ? "" : "mw-finding-warns", {}, inOrder ? text : `\u26a0 ${text}`))));
  }

  _fact(title) {
    const value = node("dd");
    this._facts.append(node("div", "mw-fact", {}, node("dt", "", {}, title), value));
    return value;
  }

  _makeSteps() {
    const request = (word) => () => this._card.request(word);
    this._undo = button("mw-tool", "Undo (U)", { sign: "undo", act: request("undo") });
    this._redo = button("mw-tool", "Redo (Shift+U)", { sign: "redo", act: request("redo") });
    this._smooth = button("mw-tool", "Smooth the whole mesh", { sign: "smooth", act: request("smooth") });
    this._clean = button("mw-tool", "Clean all: remove every removable global line", {
      sign: "clean", act: request("clean_all"),
    });
    this._untangle = button("mw-tool mw-tool-warning", "Untangle: repair the inverted elements", {
      sign: "alert", act: request("untangle"),
    });
    this._auto = button("mw-tool mw-tool-text", "Smooth around every operation automatically", { text: "Auto" });
    this._auto.addEventListener("click", () => {
      this._card.request("auto_smooth", { on: this._auto.getAttribute("aria-pressed") !== "true" });
    });
    this._steps = node("div", "mw-tools", { role: "toolbar", "aria-label": "History and smoothing" },
      this._undo, this._redo, node("span", "mw-tools-gap"),
      this._smooth, this._auto, this._clean, this._untangle);
  }

  _updateSteps(head) {
    const locked = this._card.readOnly;
    this._steps.hidden = locked;
    this._undo.disabled = !head.can_undo;
    this._redo.disabled = !head.can_redo;
    this._steps.hidden = locked;
    this._clean.hidden = head.kind !== "quad";
    this._untangle.hidden = !head.inverted;
    this._auto.setAttribute("aria-pressed", String(head.auto_smooth));
  }
}
