// The visible part of the plane, and its map to the screen; as in meshwright.graphics.viewport.

import { clamp } from "../numbers.js";

const NEAREST_PIXELS = 1e-3;
const FARTHEST_PIXELS = 1e8;

/** Centre of the view, pixels per unit of length, size in CSS pixels; y goes up in the plane. */
export class Viewport {
  constructor(x = 0, y = 0, pixels = 100, width = 1, height = 1) {
    this.x = x;
    this.y = y;
    this.pixels = pixels;
    this.width = width;
    this.height = height;
  }

  toScreen(x, y) {
    return [
      this.width / 2 + (x - this.x) * this.pixels,
      this.height / 2 - (y - this.y) * this.pixels,
    ];
  }

  toPlane(x, y) {
    return [
      this.x + (x - this.width / 2) / this.pixels,
      this.y - (y - this.height / 2) / this.pixels,
    ];
  }

  /** The box of the plane that is seen, with `margin` pixels around it. */
  box(margin = 0) {
    const [left, top] = this.toPlane(-margin, -margin);
    const [right, bottom] = this.toPlane(this.width + margin, this.height + margin);
    return { left, bottom, right, top };
  }

  /** Zoomed in by `factor`; the point at (x, y) stays there. */
  zoomed(factor, x, y) {
    const pixels = Math.min(Math.max(this.pixels * factor, NEAREST_PIXELS), FARTHEST_PIXELS);
    const [px, py] = this.toPlane(x, y);
    return new Viewport(
      px - (x - this.width / 2) / pixels,
      py + (y - this.height / 2) / pixels,
      pixels, this.width, this.height,
    );
  }

  /** Panned by (dx, dy) pixels. */
  panned(dx, dy) {
    return new Viewport(
      this.x - dx / this.pixels, this.y + dy / this.pixels, this.pixels, this.width, this.height,
    );
  }

  resized(width, height) {
    return new Viewport(this.x, this.y, this.pixels, width, height);
  }

  /** The view of all of a box {left, bottom, right, top} with `margin` pixels around it. */
  fitted(box, margin) {
    const wide = Math.max(box.right - box.left, 1e-9);
    const high = Math.max(box.top - box.bottom, 1e-9);
    const room = [Math.max(this.width - 2 * margin, 16), Math.max(this.height - 2 * margin, 16)];
    const pixels = Math.min(room[0] / wide, room[1] / high);
    const middle = [(box.left + box.right) / 2, (box.bottom + box.top) / 2];
    return new Viewport(middle[0], middle[1], pixels, this.width, this.height);
  }

  /** Centred on (x, y) and zoomed in until 2 * reach is `least` pixels; never zoomed out. */
  around(x, y, reach, least) {
    const pixels = Math.max(this.pixels, least / Math.max(2 * reach, 1e-9));
    return new Viewport(x, y, Math.min(pixels, FARTHEST_PIXELS), this.width, this.height);
  }

  /** This view with its centre clamped to a box {left, bottom, right, top}. */
  over(box) {
    if (!box) return this;
    const [x, y] = [clamp(this.x, box.left, box.right), clamp(this.y, box.bottom, box.top)];
    return new Viewport(x, y, this.pixels, this.width, this.height);
  }
}
