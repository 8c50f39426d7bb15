// A uniform grid of cells with the elements that touch them; updated incrementally by patches.

import { clamp } from "../numbers.js";
import { boxOf } from "./sides.js";
import { withRoom } from "./typed_arrays.js";

export class SpatialGrid {
  /** All live elements of `replica`, about one per cell. */
  constructor(replica) {
    const box = replica.bounds() || { left: 0, bottom: 0, right: 1, top: 1 };
    const [wide, high] = [box.right - box.left || 1, box.top - box.bottom || 1];
    this._replica = replica;
    this._left = box.left;
    this._bottom = box.bottom;
    this._size = Math.sqrt((wide * high) / Math.max(replica.elements, 1)) || 1;
    this._size = Math.max(this._size, Math.max(wide, high) / 1000);
    this._columns = Math.floor(wide / this._size) + 1;
    this._rows = Math.floor(high / this._size) + 1;
    this._cells = Array.from({ length: this._columns * this._rows }, () => []);
    this._ranges = new Map();
    this._stamps = new Int32Array(replica.elements + 64);
    this._stamp = 0;
    this.made = replica.elements;
    for (let e = 0; e < replica.elements; e += 1) this.add(e);
  }

  /** Add an element at its present position; dead ones are ignored. */
  add(e) {
    const box = boxOf(this._replica, e);
    if (!box) return;
    const range = this._range(box.left, box.bottom, box.right, box.top);
    this._ranges.set(e, range);
    this._each(range, (cell) => cell.push(e));
  }

  /** Remove an element from the cells it was added to. */
  remove(e) {
    const range = this._ranges.get(e);
    if (!range) return;
    this._ranges.delete(e);
    this._each(range, (cell) => {
      const at = cell.indexOf(e);
      cell[at] = cell[cell.length - 1];
      cell.pop();
    });
  }

  /** Elements that may touch a box of the plane, each once. */
  near(left, bottom, right, top) {
    this._stamp += 1;
    this._stamps = withRoom(this._stamps, this._replica.elements);
    const found = [];
    this._each(this._range(left, bottom, right, top), (cell) => {
      for (const e of cell) {
        if (this._stamps[e] === this._stamp) continue;
        this._stamps[e] = this._stamp;
        found.push(e);
      }
    });
    return found;
  }

  _range(left, bottom, right, top) {
    const column = (x) => clamp(Math.floor((x - this._left) / this._size), 0, this._columns - 1);
    const row = (y) => clamp(Math.floor((y - this._bottom) / this._size), 0, this._rows - 1);
    return [column(left), row(bottom), column(right), row(top)];
  }

  _each([left, bottom, right, top], visit) {
    for (let j = bottom; j <= top; j += 1) {
      for (let i = left; i <= right; i += 1) visit(this._cells[j * this._columns + i]);
    }
  }
}
