// Paints markers of vertices: corners, irregular vertices with their signed number, locks, pins.
//
// Sizes are those of meshwright.graphics.markers. In crowded places a disc keeps its number as long as
// it does not cover the next one; otherwise it is a plain dot until the view is zoomed in.

import { FLAG_ANCHOR, FLAG_CORNER } from "../mesh/mesh_replica.js";
import { clamp, signed } from "../numbers.js";

const BASE_RADIUS = 10;
const RADIUS_GROWTH = 2.5;
const LARGEST_RADIUS = 16;
const SMALLEST_RADIUS = 2;
const CROWDED = 0.36;
const CROWDED_DISCS = 0.58;
const READABLE = 5.5;
const READABLE_BEST = 7;
const CORNER_HALF = 4;
/** An anchor, where a straight side meets a curve without a corner, has a small hollow mark. */
const ANCHOR_HALF = 2.75;
const ANCHOR_LINE = 1.25;
const FEW_CORNERS = 64;
const LOCK_RADIUS = 12.5;
/** A pinned vertex has a needle to this far right of it and above it, with a head of this radius. */
const PIN = { right: 5, up: 10, radius: 3.2 };
/** Extent of a marker in pixels, and the margin of repainted regions. */
const MARK_REACH = 20;
export const MARK_SLACK = 36;

/** Radius in pixels: larger with |delta|, smaller where the edges or the next disc are near. */
function discRadius(delta, reach, apart) {
  const wanted = Math.min(BASE_RADIUS + RADIUS_GROWTH * (Math.abs(delta) - 1), LARGEST_RADIUS);
  const room = Math.max(CROWDED * reach, Math.min(READABLE_BEST, CROWDED_DISCS * apart));
  return Math.max(Math.min(wanted, room), SMALLEST_RADIUS);
}

/** Whether a vertex of these flags has the large mark of a corner. */
function isCorner(flags) {
  return (flags & FLAG_CORNER) !== 0 && (flags & FLAG_ANCHOR) === 0;
}

export class Markers {
  constructor(colours) {
    this._colours = colours;
    this._sprites = new Map();
    this._ratio = 0;
  }

  /** Discard the sprites after a change of colours. */
  forget() {
    this._sprites.clear();
  }

  /** Paint the markers that reach one of `boxes` {left, top, right, bottom} of the screen. */
  paint(pen, ratio, view, replica, derived, boxes) {
    if (ratio !== this._ratio) {
      this._sprites.clear();
      this._ratio = ratio;
    }
    const { places } = replica;
    const [shiftX, shiftY] = view.toScreen(0, 0);
    const inside = (v) => {
      const x = shiftX + places[2 * v] * view.pixels;
      const y = shiftY - places[2 * v + 1] * view.pixels;
      const near = (box) => x > box.left - MARK_REACH && x < box.right + MARK_REACH
        && y > box.top - MARK_REACH && y < box.bottom + MARK_REACH;
      return boxes.some(near) ? [x, y] : null;
    };
    this._paintCorners(pen, view, derived, inside);
    for (const v of derived.irregular) {
      const at = inside(v);
      if (at) this._paintDisc(pen, view, replica, derived, v, at);
    }
    pen.lineWidth = 1.5;
    pen.strokeStyle = this._colours.boundary;
    for (const v of derived.locked) {
      const at = inside(v);
      if (!at) continue;
      pen.beginPath();
      pen.arc(at[0], at[1], LOCK_RADIUS, 0, 2 * Math.PI);
      pen.stroke();
    }
    pen.fillStyle = this._colours.accent;
    for (const v of derived.pinned) {
      const at = inside(v);
      if (!at) continue;
      const [x, y] = [at[0] + PIN.right, at[1] - PIN.up];
      pen.beginPath();
      pen.moveTo(at[0], at[1]);
      pen.lineTo(x, y);
      pen.stroke();
      pen.beginPath();
      pen.arc(x, y, PIN.radius, 0, 2 * Math.PI);
      pen.fill();
    }
  }

  /** Radius of the disc of an irregular vertex, in pixels. */
  radius(view, replica, derived, v) {
    const apart = derived.apart[v] * view.pixels;
    return discRadius(replica.delta[v], derived.reach[v] * view.pixels, apart);
  }

  _paintCorners(pen, view, derived, inside) {
    const many = derived.corners.length + derived.anchors.length > FEW_CORNERS;
    const half = many ? clamp(0.3 * derived.typical * view.pixels, 1, CORNER_HALF) : CORNER_HALF;
    pen.fillStyle = this._colours.corner;
    for (const v of derived.corners) {
      const at = inside(v);
      if (at) pen.fillRect(at[0] - half, at[1] - half, 2 * half, 2 * half);
    }
    const small = Math.min(half, ANCHOR_HALF);
    pen.fillStyle = this._colours.background;
    pen.strokeStyle = this._colours.corner;
    pen.lineWidth = Math.min(ANCHOR_LINE, small);
    pen.lineJoin = "miter";
    for (const v of derived.anchors) {
      const at = inside(v);
      if (!at) continue;
      pen.fillRect(at[0] - small, at[1] - small, 2 * small, 2 * small);
      pen.strokeRect(at[0] - small, at[1] - small, 2 * small, 2 * small);
    }
    pen.lineJoin = "round";
  }

  _paintDisc(pen, view, replica, derived, v, [x, y]) {
    const radius = Math.round(2 * this.radius(view, replica, derived, v)) / 2;
    const sprite = this._sprite(replica.delta[v], radius, isCorner(replica.flags[v]));
    const ratio = this._ratio;
    const [left, top] = [x - sprite.width / ratio / 2, y - sprite.height / ratio / 2];
    pen.drawImage(
      sprite, Math.round(left * ratio) / ratio, Math.round(top * ratio) / ratio,
      sprite.width / ratio, sprite.height / ratio,
    );
  }

  _sprite(delta, radius, corner) {
    const key = `${delta} ${radius} ${corner}`;
    let sprite = this._sprites.get(key);
    if (!sprite) {
      sprite = this._made(delta, radius, corner);
      this._sprites.set(key, sprite);
    }
    return sprite;
  }

  _made(delta, radius, corner) {
    const colours = this._colours;
    const half = Math.ceil((radius + 2) * this._ratio);
    const sprite = document.createElement("canvas");
    sprite.width = sprite.height = 2 * half;
    const pen = sprite.getContext("2d");
    pen.setTransform(this._ratio, 0, 0, this._ratio, half, half);
    if (corner) {
      pen.fillStyle = colours.corner;
      pen.fillRect(-radius - 0.5, -radius - 0.5, 2 * radius + 1, 2 * radius + 1);
    }
    const disc = (colour, r) => {
      pen.fillStyle = colour;
      pen.beginPath();
      pen.arc(0, 0, r, 0, 2 * Math.PI);
      pen.fill();
    };
    if (radius > 4) disc(colours.background, radius + 1.2);
    disc(delta > 0 ? colours.plus : colours.minus, radius);
    if (radius >= READABLE) {
      const text = signed(delta);
      const size = Math.max(8, (text.length > 2 ? 0.95 : 1.2) * radius, Math.min(9, 1.45 * radius));
      pen.font = `600 ${size}px ${colours.font}`;
      pen.fillStyle = colours.marker_text;
      const box = pen.measureText(text); // centred by its bounding box: font metrics differ
      pen.fillText(
        text, (box.actualBoundingBoxLeft - box.actualBoundingBoxRight) / 2,
        (box.actualBoundingBoxAscent - box.actualBoundingBoxDescent) / 2,
      );
    }
    return sprite;
  }
}
