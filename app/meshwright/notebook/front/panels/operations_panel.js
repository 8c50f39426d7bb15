// A row for each operation: key, change of s at the current half-edge, armed or not.

import { asSentence, node, setText } from "../dom.js";
import { signed } from "../numbers.js";

export class OperationsPanel {
  constructor(card) {
    this._card = card;
    this._rows = [];
    this._catalogue = null;
    this._hint = node("p", "mw-hint");
    this._list = node("div", "mw-operations", { role: "group", "aria-label": "Operations" });
    this.root = node("section", "mw-part mw-part-operations", { "aria-label": "Operations" },
      node("h4", "mw-heading", {}, "Operations"), this._hint, this._list);
  }

  /** Show what is known of the current half-edge. */
  update() {
    const { replica, hoverState, colours, readOnly } = this._card;
    this.root.hidden = readOnly;
    if (this._catalogue !== replica.catalogue) this._fill(replica.catalogue);
    for (const { info, row, change } of this._rows) {
      const offer = hoverState.offers ? hoverState.offers.get(info.operation) : null;
      const refused = Boolean(offer) && !offer.allowed;
      const known = Boolean(offer) && offer.change !== null && !refused;
      setText(change, known ? signed(offer.change) : "");
      change.style.color = known ? colours.ofChange(offer.change) : "";
      row.classList.toggle("mw-refused", refused);
      row.classList.toggle("mw-meant", hoverState.previewed === info.operation);
      const armed = hoverState.armed === info.operation;
      row.setAttribute("aria-pressed", String(armed));
      const summary = asSentence(info.summary);
      const title = refused ? `${summary}\nNot here: ${asSentence(offer.reason)}`
        : `${summary}\n${armed ? "A click on the mesh applies it." : "Click to choose it; each click on the mesh then applies it."}`;
      if (row.title !== title) row.title = title;
    }
    setText(this._hint, this._hintText());
  }

  _hintText() {
    const { replica, hoverState } = this._card;
    const armed = replica.catalogue.find((info) => info.operation === hoverState.armed);
    if (armed) return "A click applies it. Esc cancels.";
    return hoverState.offers ? "How each operation changes s here." : "Point at a half-edge of the mesh.";
  }

  _fill(catalogue) {
    this._catalogue = catalogue;
    this._rows = catalogue.map((info) => {
      const change = node("span", "mw-change");
      const row = node("button", "mw-operation", { type: "button", "aria-pressed": "false" },
        node("kbd", "mw-key", { "aria-hidden": "true" }, info.key),
        node("span", "mw-operation-title", {}, info.title), change);
      row.addEventListener("click", () => this._card.hoverState.arm(info.operation));
      return { info, row, change };
    });
    this._list.replaceChildren(...this._rows.map(({ row }) => row));
  }
}
