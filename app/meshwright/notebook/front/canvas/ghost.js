// The preview of an operation ("ghost"): new edges dashed, removed edges faded, new irregularities.

import { middleOf } from "../mesh/picking.js";
import { arrayOf } from "../mesh/typed_arrays.js";
import { clamp, signed } from "../numbers.js";

const GHOST_DASHES = [7, 4.5];
const MOST_NUMBERS = 24;
const NUMBERS_ROOM = 26;
const CROSS_HALF = 5;
const PILL_HEIGHT = 15;
const TAG_HEIGHT = 24;
const TAG_GAPS = [14, 36];
const TAG_HIDES = 60;

/** The content of a ghost message, in the plane: {halfedge, operation, change, added, removed, gone,
 * places, delta}; segments are flat [x, y, x, y, ...]; null if nothing is allowed.
 */
export function ghostOf(content, buffers) {
  if (content.operation === null || content.operation === undefined) return null;
  return {
    halfedge: content.halfedge,
    operation: content.operation,
    change: content.change,
    added: arrayOf(Float32Array, buffers[0]),
    removed: arrayOf(Float32Array, buffers[1]),
    gone: arrayOf(Float32Array, buffers[2]),
    places: arrayOf(Float32Array, buffers[3]),
    delta: arrayOf(Int8Array, buffers[4]),
  };
}

/** {left, top, right, bottom} of a ghost and of the corners at its half-edge, on the screen. */
export function ghostBounds(view, ghost, corners) {
  const box = { left: Infinity, top: Infinity, right: -Infinity, bottom: -Infinity };
  const take = ([x, y]) => {
    box.left = Math.min(box.left, x);
    box.right = Math.max(box.right, x);
    box.top = Math.min(box.top, y);
    box.bottom = Math.max(box.bottom, y);
  };
  corners.forEach(take);
  if (ghost) {
    for (const flat of [ghost.added, ghost.removed, ghost.places]) {
      for (let i = 0; i < flat.length; i += 2) take(view.toScreen(flat[i], flat[i + 1]));
    }
  }
  return box;
}

export class GhostPainter {
  constructor(colours) {
    this._colours = colours;
  }

  /** Paint the edges; they lie below the markers. `fill`: the colour that fades removed ones. */
  paintEdges(pen, view, ghost, fill) {
    const colours = this._colours;
    const stroke = (colour, width, alpha, dashes, segments) => {
      pen.globalAlpha = alpha;
      pen.strokeStyle = colour;
      pen.lineWidth = width;
      pen.setLineDash(dashes);
      segmentsPath(pen, view, segments);
      pen.stroke();
    };
    pen.lineCap = "round";
    stroke(fill, 4, 0.86, [], ghost.removed);
    pen.lineCap = "butt";
    stroke(colours.background, 4, 0.8, [], ghost.added);
    stroke(colours.arrow, 1.9, 1, GHOST_DASHES, ghost.added);
    pen.setLineDash([]);
    pen.globalAlpha = 1;
  }

  /** Paint labels with the new irregularity of vertices, crosses on removed ones, and a tag with the
   * title unless that is empty. `corners`: of the half-edge's element, on the screen, its own ends
   * first.
   */
  paintNumbers(pen, view, ghost, title, corners, marks) {
    const size = Math.max(
      ...corners.map((at) => Math.hypot(at[0] - corners[0][0], at[1] - corners[0][1])),
    );
    const busy = [...marks];
    if (size > NUMBERS_ROOM && ghost.delta.length <= MOST_NUMBERS) {
      busy.push(...this._paintPills(pen, view, ghost, corners, marks));
      this._paintCrosses(pen, view, ghost);
    }
    const [x, y] = middleOf(corners);
    const seen = title && x > 0 && y > 0 && x < view.width && y < view.height;
    if (seen) this._paintTag(pen, view, ghost, title, corners, busy);
  }

  _paintCrosses(pen, view, ghost) {
    if (ghost.gone.length > 2 * MOST_NUMBERS) return;
    pen.lineCap = "round";
    for (const [colour, width] of [[this._colours.background, 6], [this._colours.text, 2.25]]) {
      pen.strokeStyle = colour;
      pen.lineWidth = width;
      pen.beginPath();
      for (let i = 0; i < ghost.gone.length; i += 2) {
        const [x, y] = view.toScreen(ghost.gone[i], ghost.gone[i + 1]);
        pen.moveTo(x - CROSS_HALF, y - CROSS_HALF);
        pen.lineTo(x + CROSS_HALF, y + CROSS_HALF);
        pen.moveTo(x - CROSS_HALF, y + CROSS_HALF);
        pen.lineTo(x + CROSS_HALF, y - CROSS_HALF);
      }
      pen.stroke();
    }
  }

  /** Paint the labels beside their vertices, without overlaps if possible; returns their centres. */
  _paintPills(pen, view, ghost, corners, marks) {
    const colours = this._colours;
    pen.font = `600 11px ${colours.font}`;
    pen.textBaseline = "middle";
    pen.textAlign = "center";
    const [a, b] = corners;
    const along = (t) => [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
    const busy = [...marks, ...[0.15, 0.4, 0.65, 0.9].map(along)];
    const pills = [];
    ghost.delta.forEach((delta, i) => {
      const [x, y] = view.toScreen(ghost.places[2 * i], ghost.places[2 * i + 1]);
      const text = signed(delta);
      const width = Math.max(pen.measureText(text).width + 8, 15);
      const tries = [[x + 9, y - 23], [x - 9 - width, y - 23], [x + 9, y + 8], [x - 9 - width, y + 8]];
      const hits = tries.map(([left, top]) => busy.filter(([px, py]) => px > left - 9
        && px < left + width + 9 && py > top - 9 && py < top + PILL_HEIGHT + 9).length);
      const [left, top] = tries[hits.indexOf(Math.min(...hits))];
      pills.push([left + width / 2, top + PILL_HEIGHT / 2]);
      busy.push(pills[pills.length - 1]);
      pen.fillStyle = colours.raised;
      pen.lineWidth = 1.25;
      pen.strokeStyle = delta > 0 ? colours.plus : delta < 0 ? colours.minus : colours.faint;
      pen.beginPath();
      pen.roundRect(left, top, width, PILL_HEIGHT, PILL_HEIGHT / 2);
      pen.fill();
      pen.stroke();
      pen.fillStyle = colours.text;
      pen.fillText(text, left + width / 2, top + PILL_HEIGHT / 2 + 0.5);
    });
    return pills;
  }

  _paintTag(pen, view, ghost, title, corners, marks) {
    const colours = this._colours;
    pen.font = `600 12px ${colours.font}`;
    pen.textBaseline = "middle";
    const change = signed(ghost.change);
    const width = pen.measureText(title).width + pen.measureText(change).width + 32;
    const [x, y] = this._tagPlace(view, ghost, corners, width, marks);
    pen.fillStyle = colours.raised;
    pen.strokeStyle = colours.line;
    pen.lineWidth = 1;
    pen.beginPath();
    pen.roundRect(x, y, width, TAG_HEIGHT, 6);
    pen.fill();
    pen.stroke();
    pen.fillStyle = colours.text;
    pen.textAlign = "left";
    pen.fillText(title, x + 9, y + TAG_HEIGHT / 2 + 0.5);
    pen.fillStyle = colours.ofChange(ghost.change);
    pen.textAlign = "right";
    pen.fillText(change, x + width - 9, y + TAG_HEIGHT / 2 + 0.5);
  }

  /** The place beside the element where the tag hides least. */
  _tagPlace(view, ghost, corners, width, marks) {
    const xs = corners.map((at) => at[0]);
    const ys = corners.map((at) => at[1]);
    const [x, y] = middleOf(corners.slice(0, 2));
    const hidden = [...marks];
    if (ghost.added.length <= 4 * MOST_NUMBERS) {
      for (let i = 0; i < ghost.added.length; i += 4) {
        for (const share of [0.15, 0.5, 0.85]) {
          hidden.push(view.toScreen(
            ghost.added[i] + share * (ghost.added[i + 2] - ghost.added[i]),
            ghost.added[i + 1] + share * (ghost.added[i + 3] - ghost.added[i + 1]),
          ));
        }
      }
    }
    const tries = TAG_GAPS.flatMap((gap) => [
      [Math.max(...xs) + gap, y - TAG_HEIGHT / 2],
      [Math.min(...xs) - gap - width, y - TAG_HEIGHT / 2],
      [x - width / 2, Math.min(...ys) - gap - TAG_HEIGHT],
      [x - width / 2, Math.max(...ys) + gap],
    ]);
    let best = null;
    let least = Infinity;
    for (const [wantedX, wantedY] of tries) {
      const left = clamp(wantedX, 8, Math.max(view.width - width - 8, 8));
      const top = clamp(wantedY, 8, Math.max(view.height - TAG_HEIGHT - 8, 8));
      let cost = Math.hypot(left + width / 2 - x, 2 * (top + TAG_HEIGHT / 2 - y));
      for (const [px, py] of hidden) {
        const inside = px > left - 8 && px < left + width + 8 && py > top - 8 && py < top + TAG_HEIGHT + 8;
        if (inside) cost += TAG_HIDES;
      }
      if (cost < least) [best, least] = [[left, top], cost];
    }
    return best;
  }
}

/** Begin a path of flat segments [x, y, x, y, ...] of the plane; those out of view are left out.
 * Segments that begin where the one before ends are one line, with one row of dashes.
 */
function segmentsPath(pen, view, segments) {
  let [lastX, lastY] = [NaN, NaN];
  pen.beginPath();
  for (let i = 0; i < segments.length; i += 4) {
    const [ax, ay] = view.toScreen(segments[i], segments[i + 1]);
    const [bx, by] = view.toScreen(segments[i + 2], segments[i + 3]);
    if (Math.max(ax, bx) < 0 || Math.min(ax, bx) > view.width) continue;
    if (Math.max(ay, by) < 0 || Math.min(ay, by) > view.height) continue;
    if (ax !== lastX || ay !== lastY) pen.moveTo(ax, ay);
    [lastX, lastY] = [bx, by];
    pen.lineTo(bx, by);
  }
}
