// Mouse, pen and touch on the canvas.
//
// Mouse and pen: hover, click, drag pans, right click opens the menu of the vertex. Touch: one finger
// scrolls the page, a tap opens the menu of the half-edge, a long press that of the vertex, two
// fingers pan and zoom. The wheel zooms with Ctrl (or Command), or while the canvas has the focus;
// otherwise it scrolls the page.

import { middleOf } from "../mesh/picking.js";
import { clamp } from "../numbers.js";

const CLICK_SLACK = { mouse: 4, pen: 7, touch: 12 };
const OUTSIDE_REACH = { mouse: 8, pen: 12, touch: 22 };
const VERTEX_REACH = { mouse: 14, pen: 18, touch: 28 };
const HOLD = 500;
const LINE_HEIGHT = 16;

export class Pointer {
  constructor(card, surface) {
    this.place = null; // [x, y] of the mouse on the canvas, null outside
    this.dragging = false;
    this._card = card;
    this._surface = surface;
    this._down = new Map();
    this._moved = false;
    this._hold = 0;
    this._calls = new AbortController();
    const on = (type, handler, more = {}) =>
      surface.addEventListener(type, handler.bind(this), { signal: this._calls.signal, ...more });
    on("pointerdown", this._onDown);
    on("pointermove", this._onMove);
    on("pointerup", this._onUp);
    on("pointercancel", this._onCancel);
    on("pointerleave", this._onLeave);
    on("wheel", this._onWheel, { passive: false });
    on("dblclick", this._onDouble);
    on("contextmenu", this._onContext);
    for (const type of ["touchstart", "touchmove"]) on(type, this._onTouch, { passive: false });
  }

  release() {
    clearTimeout(this._hold);
    this._calls.abort();
  }

  /** The half-edge under the mouse now, -1 for none. */
  halfedge(type = "mouse") {
    return this.place ? this._card.pick(this.place, OUTSIDE_REACH[type]) : -1;
  }

  _at(event) {
    const box = this._surface.getBoundingClientRect();
    const scale = box.width ? this._surface.clientWidth / box.width : 1;
    return [(event.clientX - box.left) * scale, (event.clientY - box.top) * scale];
  }

  _onDown(event) {
    const at = this._at(event);
    if (event.pointerType !== "touch") this.place = at;
    if (event.button !== 0 && event.button !== 1) return;
    if (event.button === 1) event.preventDefault();
    this._card.focusCanvas();
    this._down.set(event.pointerId, { at, start: at, type: event.pointerType, button: event.button });
    this._moved = this._moved && this._down.size > 1;
    if (event.pointerType !== "touch") this._surface.setPointerCapture(event.pointerId);
    clearTimeout(this._hold);
    if (this._down.size === 1 && event.pointerType === "touch") {
      this._hold = setTimeout(() => {
        this._moved = true;
        this._openVertex(at, "touch");
      }, HOLD);
    } else if (this._down.size > 1) this._moved = true;
  }

  _onMove(event) {
    const at = this._at(event);
    const held = this._down.get(event.pointerId);
    if (!held) {
      if (event.pointerType !== "touch") this._hover(at, event.pointerType);
      return;
    }
    const slack = CLICK_SLACK[held.type] || CLICK_SLACK.mouse;
    if (Math.hypot(at[0] - held.start[0], at[1] - held.start[1]) > slack) {
      if (!this._moved && held.type !== "touch") this._startDrag();
      this._moved = true;
      clearTimeout(this._hold);
    }
    if (this._down.size === 2) this._pinch(event.pointerId, at);
    else if (this._moved && held.type !== "touch") {
      this.place = at;
      this._card.stage.pan(at[0] - held.at[0], at[1] - held.at[1]);
    }
    held.at = at;
  }

  _onUp(event) {
    const held = this._down.get(event.pointerId);
    this._end(event.pointerId);
    if (!held || this._moved) {
      if (held && held.type !== "touch") this._hover(this._at(event), held.type);
      return;
    }
    if (held.button !== 0) return;
    const halfedge = this._card.pick(held.at, OUTSIDE_REACH[held.type] || OUTSIDE_REACH.mouse);
    this._card.click(halfedge, held.at, held.type !== "mouse");
  }

  _onCancel(event) {
    const held = this._down.get(event.pointerId);
    if (held && held.type === "touch" && this._down.size === 1) this._card.showTouchHint();
    this._end(event.pointerId);
    this._moved = false;
  }

  _onLeave(event) {
    if (event.pointerType === "touch" || this._down.has(event.pointerId)) return;
    this.place = null;
    this._card.leave();
  }

  _startDrag() {
    this.dragging = true;
    this._surface.dataset.dragging = "";
  }

  _end(id) {
    clearTimeout(this._hold);
    this._down.delete(id);
    this.dragging = false;
    delete this._surface.dataset.dragging;
  }

  _hover(at, type) {
    this.place = at;
    this._card.hover(this._card.pick(at, OUTSIDE_REACH[type] || OUTSIDE_REACH.mouse), at);
  }

  /** Pan and zoom with two fingers: the points under them stay under them. */
  _pinch(id, at) {
    const other = [...this._down.entries()].find(([key]) => key !== id)[1].at;
    const was = this._down.get(id).at;
    const spread = (p) => Math.max(Math.hypot(p[0] - other[0], p[1] - other[1]), 1);
    const middle = middleOf([at, other]);
    this._card.stage.pan((at[0] - was[0]) / 2, (at[1] - was[1]) / 2);
    this._card.stage.zoom(spread(at) / spread(was), ...middle);
  }

  _onTouch(event) {
    if (event.touches.length > 1) event.preventDefault(); // else the page would zoom
  }

  _onWheel(event) {
    const zooms = event.ctrlKey || event.metaKey || this._card.focused;
    if (!zooms) {
      this._card.showWheelHint();
      return;
    }
    event.preventDefault();
    const unit = event.deltaMode === 1 ? LINE_HEIGHT : event.deltaMode === 2 ? 400 : 1;
    const delta = clamp(event.deltaY * unit, -240, 240);
    const fine = event.ctrlKey && Math.abs(delta) < 40; // a pinch on a trackpad comes in small steps
    this._card.stage.zoom(Math.exp(-delta * (fine ? 0.01 : 0.002)), ...this._at(event));
  }

  _onDouble(event) {
    this._card.doubleClick(this._card.pick(this._at(event), OUTSIDE_REACH.mouse));
  }

  _onContext(event) {
    event.preventDefault();
    event.stopPropagation();
    if (event.pointerType !== "touch") this._openVertex(this._at(event), "mouse");
  }

  _openVertex(at, type) {
    this._card.menus.openVertex(at, VERTEX_REACH[type], type === "touch");
  }
}
