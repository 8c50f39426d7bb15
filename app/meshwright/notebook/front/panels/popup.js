// A context menu inside the card, operated by pointer or keyboard.

import { node } from "../dom.js";

const POPUP_GAP = 24;
const NARROW_CARD = 640;

export class Popup {
  /** `closed()` is called once, when the menu is closed. */
  constructor(card, title, { touch = false, closed = null } = {}) {
    this._card = card;
    this._closed = closed;
    this.open = true;
    this.root = node("div", "mw-popup", { role: "menu", "aria-label": title, "data-big": touch });
    this.head = node("div", "mw-popup-head", { "aria-hidden": "true" }, title);
    this.root.append(this.head);
    this.rows = [];
    this._outside = (event) => {
      if (!event.composedPath().includes(this.root)) this.close(false);
    };
    this.root.addEventListener("keydown", (event) => this._onKey(event));
    this.root.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  /** Add a row {label, parts, disabled, checked, key, act, pointed}. */
  addRow(row) {
    const role = row.checked === undefined ? "menuitem" : "menuitemcheckbox";
    const made = node("button", "mw-row", {
      type: "button", role, tabindex: "-1", "aria-label": row.label,
      "aria-disabled": row.disabled ? "true" : null,
      "aria-checked": row.checked === undefined ? null : String(row.checked),
    }, ...row.parts);
    made.addEventListener("click", () => this._take(row));
    made.addEventListener("pointerenter", () => made.focus({ preventScroll: true }));
    made.addEventListener("focus", () => row.pointed && row.pointed());
    this.rows.push({ ...row, element: made });
    this.root.append(made);
    return made;
  }

  /** Remove all rows. */
  clear() {
    this.rows = [];
    this.root.replaceChildren(this.head);
  }

  /** Show it beside a point of the card, in pixels; inside the card. */
  show(x, y) {
    const { root } = this._card;
    root.append(this.root);
    const [width, height] = [this.root.offsetWidth, this.root.offsetHeight];
    const [roomX, roomY] = [root.clientWidth - 8, root.clientHeight - 8];
    const narrow = root.clientWidth < NARROW_CARD; // there is room below, but not beside
    let left = x + POPUP_GAP;
    let top = y - 16;
    if (narrow) [left, top] = [x - width / 2, y + 2 * POPUP_GAP];
    else if (left + width > roomX && x - POPUP_GAP - width > 8) left = x - POPUP_GAP - width;
    this.root.style.left = `${Math.max(Math.min(left, roomX - width), 8)}px`;
    this.root.style.top = `${Math.max(Math.min(top, roomY - height), 8)}px`;
    this.root.tabIndex = -1;
    this.root.focus({ preventScroll: true });
    document.addEventListener("pointerdown", this._outside, true);
  }

  close(focus = true) {
    if (!this.open) return;
    this.open = false;
    document.removeEventListener("pointerdown", this._outside, true);
    this.root.remove();
    if (this._closed) this._closed();
    if (focus) this._card.focusCanvas();
  }

  /** Focus the row of this index. */
  focusRow(index) {
    if (this.rows[index]) this.rows[index].element.focus({ preventScroll: true });
  }

  _take(row) {
    if (row.disabled) return;
    this.close();
    row.act();
  }

  _onKey(event) {
    event.stopPropagation();
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const at = this.rows.findIndex((row) => row.element.matches(":focus"));
    const count = this.rows.length;
    if (event.key === "ArrowDown") this.focusRow((at + 1) % count);
    else if (event.key === "ArrowUp") this.focusRow((Math.max(at, 0) + count - 1) % count);
    else if (event.key === "Home") this.focusRow(0);
    else if (event.key === "End") this.focusRow(count - 1);
    else if (event.key === "Escape" || event.key === "Tab") this.close();
    else {
      const row = this.rows.find((one) => one.key && one.key.toLowerCase() === event.key.toLowerCase());
      if (!row) return;
      this._take(row);
    }
    event.preventDefault();
  }
}
