// The context menus: operations of a half-edge, properties of a vertex.

import { asSentence, icon, node } from "../dom.js";
import { FLAG_CORNER, FLAG_LOCKED, FLAG_PINNED } from "../mesh/mesh_replica.js";
import { signed } from "../numbers.js";
import { Popup } from "./popup.js";

/** At most one menu of a card is open. */
export class Menus {
  constructor(card) {
    this._card = card;
    this._open = null;
  }

  get open() {
    return this._open !== null;
  }

  /** Open the menu of operations of a half-edge at [x, y] of the canvas. */
  openOperations(halfedge, at, touch) {
    this._show((closed) => new OperationMenu(this._card, halfedge, { ...this._onCard(at), touch, closed }));
  }

  /** Open it for the current half-edge, with the focus in it. */
  openByKey() {
    const { hoverState, stage, readOnly } = this._card;
    if (readOnly) return;
    if (hoverState.halfedge < 0) {
      this._card.notify("refused", "Point at a half-edge first.");
      return;
    }
    hoverState.pinned = true;
    this.openOperations(hoverState.halfedge, stage.middle(hoverState.halfedge), false);
    this._open.popup.focusRow(0);
  }

  /** Open the menu of the vertex near [x, y] of the canvas. */
  openVertex(at, reach, touch) {
    const halfedge = this._card.stage.pickVertex(at, reach);
    if (halfedge < 0 || this._card.readOnly) return;
    this._show((closed) => new VertexMenu(this._card, halfedge, { ...this._onCard(at), touch, closed }));
  }

  /** Update the open menu after a change. */
  refresh() {
    if (this._open) this._open.refresh();
  }

  /** Close the open menu; returns whether there was one. */
  close(focus = true) {
    const was = this._open;
    if (was) was.popup.close(focus);
    return was !== null;
  }

  _show(makeMenu) {
    this.close(false);
    this._open = makeMenu(() => {
      this._open = null;
      this._card.hoverState.preview(null);
    });
  }

  _onCard([x, y]) {
    const { stage, root } = this._card;
    const [inner, outer] = [stage.surface, root].map((part) => part.getBoundingClientRect());
    return { x: x + inner.left - outer.left, y: y + inner.top - outer.top };
  }
}

/** All operations at a half-edge, with the change of s or the reason of a refusal. */
class OperationMenu {
  constructor(card, halfedge, { x, y, touch, closed }) {
    this._card = card;
    this.halfedge = halfedge;
    const { replica } = card;
    this._ends = [replica.origin[halfedge], replica.target(halfedge)];
    this.popup = new Popup(card, `Half-edge ${this._ends.join(" \u2192 ")}`, { touch, closed });
    this._fill();
    this.popup.show(x, y);
  }

  /** Update the rows after an answer from Python. */
  refresh() {
    const { replica, hoverState } = this._card;
    const same = replica.live(this.halfedge) && replica.origin[this.halfedge] === this._ends[0]
      && replica.target(this.halfedge) === this._ends[1];
    if (!same || hoverState.halfedge !== this.halfedge) this.popup.close();
    else if (hoverState.offers !== this._offers) this._fill();
  }

  _fill() {
    const { replica, hoverState, colours } = this._card;
    this._offers = hoverState.offers;
    const focused = this.popup.rows.findIndex((row) => row.element.matches(":focus"));
    this.popup.clear();
    for (const info of replica.catalogue) {
      const offer = this._offers ? this._offers.get(info.operation) : null;
      const refused = offer ? !offer.allowed : false;
      const known = offer && offer.change !== null;
      const change = node("span", "mw-change", {}, known ? signed(offer.change) : "");
      if (known) change.style.color = colours.ofChange(offer.change);
      const reason = refused ? asSentence(offer.reason) : "";
      this.popup.addRow({
        label: `${info.title}${known ? `, s ${signed(offer.change)}` : ""}${reason ? `. Not here: ${reason}` : ""}`,
        parts: [
          node("span", "mw-row-line", {},
            node("span", "mw-row-title", {}, info.title), change, node("kbd", "mw-key", {}, info.key)),
          reason ? node("span", "mw-reason", {}, reason) : null,
        ],
        disabled: refused || !offer,
        key: info.key,
        act: () => this._card.operate(info.operation, this.halfedge),
        pointed: () => hoverState.preview(refused || !offer ? null : info.operation),
      });
    }
    if (focused >= 0) this.popup.focusRow(focused);
  }
}

/** Desired degree, corner and lock of the vertex where a half-edge starts. */
class VertexMenu {
  constructor(card, halfedge, { x, y, touch, closed }) {
    const { replica } = card;
    this._card = card;
    this.vertex = replica.origin[halfedge];
    this._revision = replica.revision;
    const degree = replica.degree(halfedge);
    const delta = replica.delta[this.vertex];
    const flags = replica.flags[this.vertex];
    const words = `Vertex ${this.vertex}: degree ${degree}, \u0394 ${signed(delta)}`;
    this.popup = new Popup(card, words, { touch, closed });
    const desired = degree - delta;
    const choice = (title, checked, act) => this.popup.addRow({
      label: title, checked, act,
      parts: [node("span", "mw-row-line", {},
        node("span", "mw-tick", {}, ...(checked ? [icon("check", 14)] : [])),
        node("span", "mw-row-title", {}, title))],
    });
    const wanted = new Set([desired - 1, desired, desired + 1].filter((d) => d >= 1));
    for (const d of wanted) {
      choice(`Desired degree ${d}`, d === desired, () => this._send("desired", { degree: d }));
    }
    const [corner, locked] = [(flags & FLAG_CORNER) !== 0, (flags & FLAG_LOCKED) !== 0];
    choice("Corner: keeps its position", corner, () => this._send("corner", { on: !corner }));
    choice("Locked: not moved or removed", locked, () => this._send("lock", { on: !locked }));
    const pinned = (flags & FLAG_PINNED) !== 0;
    choice("Pinned: not moved by smoothing", pinned, () => this._send("pin", { on: !pinned }));
    this.popup.show(x, y);
  }

  refresh() {
    if (this._card.replica.revision !== this._revision) this.popup.close();
  }

  _send(word, fields) {
    this._card.request(word, { vertex: this.vertex, ...fields });
  }
}
