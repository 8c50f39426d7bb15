// Paints inverted elements: tinted, hatched, and with a warning sign where they are small.

import { overlap } from "../mesh/boxes.js";
import { middleOf } from "../mesh/picking.js";
import { boxOf, outlineFrom } from "../mesh/sides.js";

const HATCH_GAP = 6;
const MOST_HATCHED = 1500;
const SMALLEST_HATCHED = 9;
const MOST_SIGNS = 24;

export class InvertedElementsPainter {
  constructor(colours) {
    this._colours = colours;
    this._tile = null;
    this._ratio = 0;
  }

  /** Discard the tile after a change of colours. */
  forget() {
    this._tile = null;
  }

  /** Paint these elements in `view`; curves are followed within `tolerance`. */
  paint(pen, ratio, view, replica, elements, tolerance) {
    const seen = [];
    const window = view.box(16);
    for (const e of elements) {
      const box = boxOf(replica, e);
      if (!box || !overlap(box, window)) continue;
      seen.push(outlineFrom(replica, replica.k * e, tolerance).map(([x, y]) => view.toScreen(x, y)));
      if (seen.length >= MOST_HATCHED) break;
    }
    if (!seen.length) return;
    const pattern = pen.createPattern(this._strokes(ratio), "repeat");
    // the pattern is fixed in the plane: it moves with the mesh
    const [x, y] = view.toScreen(0, 0).map((value) => Math.round(value * ratio) / ratio);
    pattern.setTransform(new DOMMatrix([1 / ratio, 0, 0, 1 / ratio, x, y]));
    pen.lineWidth = 1.5;
    pen.strokeStyle = this._colours.warning;
    for (const corners of seen) {
      pen.beginPath();
      corners.forEach((at, i) => (i ? pen.lineTo(...at) : pen.moveTo(...at)));
      pen.closePath();
      pen.globalAlpha = 0.18;
      pen.fillStyle = this._colours.warning;
      pen.fill();
      pen.globalAlpha = 1;
      pen.fillStyle = pattern;
      pen.fill();
      pen.stroke();
    }
    const small = seen.filter((corners) => {
      const xs = corners.map((at) => at[0]);
      const ys = corners.map((at) => at[1]);
      const size = Math.min(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys));
      return size < SMALLEST_HATCHED;
    });
    if (elements.length <= MOST_SIGNS) small.forEach((corners) => this._paintSign(pen, middleOf(corners)));
  }

  _strokes(ratio) {
    if (this._tile && this._ratio === ratio) return this._tile;
    const size = Math.round(HATCH_GAP * ratio);
    const tile = document.createElement("canvas");
    tile.width = tile.height = size;
    const pen = tile.getContext("2d");
    pen.strokeStyle = this._colours.warning;
    pen.lineWidth = 0.9 * ratio;
    pen.beginPath();
    for (const shift of [-size, 0, size]) {
      pen.moveTo(shift - size, 2 * size);
      pen.lineTo(shift + 2 * size, -size);
    }
    pen.stroke();
    this._ratio = ratio;
    this._tile = tile;
    return tile;
  }

  _paintSign(pen, [cx, cy]) {
    const [x, y] = [cx - 11, cy - 13];
    const triangle = () => {
      pen.beginPath();
      pen.moveTo(x, y - 8);
      pen.lineTo(x + 9, y + 7);
      pen.lineTo(x - 9, y + 7);
      pen.closePath();
    };
    pen.fillStyle = this._colours.warning;
    pen.strokeStyle = this._colours.background;
    pen.lineWidth = 3;
    triangle();
    pen.stroke();
    pen.fill();
    pen.lineWidth = 1.75;
    pen.beginPath();
    pen.moveTo(x, y - 3);
    pen.lineTo(x, y + 1.5);
    pen.moveTo(x, y + 4.4);
    pen.lineTo(x, y + 4.6);
    pen.stroke();
  }
}
