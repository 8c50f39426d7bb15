// Edges that are not straight: pieces of curves between their ends, as
// meshwright_core.geometry.edge_curves.
//
// An edge on the boundary or on the interface of two regions runs along its curve from the parameter
// of one end to that of the other. Where its ends lie off the curve, their offsets are blended
// linearly in the parameter and added.

import { emptyBox, enclose } from "./boxes.js";

/** Distance below which a vertex counts as on its curve: places are rounded to float32. */
const ROUNDING = 2e-7;
/** Deviation from the chord, relative to its length, below which an edge is straight: that of an arc
 * of 1e-7 radians.
 */
const STRAIGHT = 1.25e-8;
/** Errors of rounding in the distance of a point from a chord. */
const NOISE = 2e-15;
/** Tolerance of paths that do not depend on the zoom. */
export const COARSE = 5e-4;
const DEEPEST = 14;
const MOST_PATHS = 4;

class EdgeCurve {
  /** The edge on `curve` from the parameter of its origin to that of its target. */
  constructor(curves, curve, from, to, ends) {
    this.curve = curve;
    this.from = from;
    this.to = to;
    this.ends = ends;
    this._curves = curves;
    this._offsets = new Float64Array(4);
    this._paths = new Map();
    this._box = null;
    const there = new Float64Array(4);
    curves.place(curve, from, there, 0);
    curves.place(curve, to, there, 2);
    for (let i = 0; i < 4; i += 2) {
      const [x, y] = [ends[i] - there[i], ends[i + 1] - there[i + 1]];
      if (Math.abs(x) > ROUNDING || Math.abs(y) > ROUNDING) this._offsets.set([x, y], i);
    }
  }

  /** Whether it is the same piece of the same curve. */
  equals(curve, from, to, ends) {
    return curve === this.curve && from === this.from && to === this.to
      && ends.every((value, i) => value === this.ends[i]);
  }

  /** The point [x, y] at w in [0, 1], linear in the parameter. */
  point(w) {
    const out = [0, 0];
    this._curves.place(this.curve, this.from + w * (this.to - this.from), out);
    this._shift(w, out, 0);
    return out;
  }

  /** Whether it deviates from its chord. */
  get bent() {
    const path = this._sampled(-1, 2);
    const last = path.length - 2;
    const chord = Math.hypot(path[last] - path[0], path[last + 1] - path[1]);
    const most = Math.max(STRAIGHT * chord, NOISE);
    for (let i = 2; i < last; i += 2) {
      const away = awayFromChord(path[0], path[1], path[last], path[last + 1], path[i], path[i + 1]);
      if (away > most) return true;
    }
    return false;
  }

  /** {left, bottom, right, top} around it. */
  get box() {
    if (!this._box) {
      const path = this.path(COARSE);
      const box = emptyBox();
      for (let i = 0; i < path.length; i += 2) enclose(box, path[i], path[i + 1]);
      this._box = {
        left: box.left - COARSE, bottom: box.bottom - COARSE,
        right: box.right + COARSE, top: box.top + COARSE,
      };
    }
    return this._box;
  }

  /** Points [x, y, x, y, ...] from end to end whose polyline is within `tolerance`, rounded down to
   * a power of two: one path serves a step of the zoom.
   */
  path(tolerance) {
    const step = tolerance === COARSE ? COARSE : 2 ** Math.floor(Math.log2(tolerance));
    let path = this._paths.get(step);
    if (!path) {
      if (this._paths.size >= MOST_PATHS) this._paths.clear();
      path = this._sampled(step, DEEPEST);
      this._paths.set(step, path);
    }
    return path;
  }

  _sampled(tolerance, deepest) {
    const backward = this.to < this.from;
    const [low, high] = backward ? [this.to, this.from] : [this.from, this.to];
    const points = [];
    const [a, b] = [[0, 0], [0, 0]];
    const at = (piece, u, out) => {
      this._curves.placeInSpan(piece.span, u, out, 0);
      const w = (piece.start + u * piece.extent - low) / (high - low);
      this._shift(backward ? 1 - w : w, out, 0);
      return out;
    };
    const pieces = this._curves.pieces(this.curve, low, high);
    pieces.forEach((piece, i) => {
      at(piece, piece.from, a);
      if (i === 0) points.push(...a);
      if (this._curves.degree(piece.span) > 1) {
        refine((u) => at(piece, u, [0, 0]), piece.from, a, piece.to, at(piece, piece.to, b), tolerance,
          deepest, points);
      }
      points.push(...at(piece, piece.to, b));
    });
    const path = Float64Array.from(points);
    return backward ? reversed(path) : path;
  }

  _shift(w, out, at) {
    const offsets = this._offsets;
    out[at] += (1 - w) * offsets[0] + w * offsets[2];
    out[at + 1] += (1 - w) * offsets[1] + w * offsets[3];
  }
}

/** Push the points between u and v that a polyline within `tolerance` needs; `a` and `b` are the
 * points at both.
 */
function refine(at, u, a, v, b, tolerance, depth, points) {
  const middle = (u + v) / 2;
  const [p, q, r] = [at((u + middle) / 2), at(middle), at((middle + v) / 2)];
  const away = (point) => awayFromChord(a[0], a[1], b[0], b[1], point[0], point[1]);
  const last = depth === 0 || Math.max(away(p), away(q), away(r)) <= tolerance;
  if (last) return;
  refine(at, u, a, middle, q, tolerance, depth - 1, points);
  points.push(q[0], q[1]);
  refine(at, middle, q, v, b, tolerance, depth - 1, points);
}

/** Distance of (x, y) from the segment from (ax, ay) to (bx, by). */
export function awayFromChord(ax, ay, bx, by, x, y) {
  const [ux, uy] = [bx - ax, by - ay];
  const along = ((x - ax) * ux + (y - ay) * uy) / Math.max(ux * ux + uy * uy, 1e-300);
  const share = Math.min(Math.max(along, 0), 1);
  return Math.hypot(ax + share * ux - x, ay + share * uy - y);
}

function reversed(path) {
  const back = new Float64Array(path.length);
  for (let i = 0, j = path.length - 2; i < path.length; i += 2, j -= 2) {
    back[i] = path[j];
    back[i + 1] = path[j + 1];
  }
  return back;
}

/** The edges of a mesh that are not straight, by half-edge. */
export class EdgeCurves {
  constructor() {
    this._edges = new Map();
    this._elements = new Set();
  }

  /** The curves of all such half-edges. */
  all() {
    return this._edges.values();
  }

  /** The curve of a half-edge; undefined if it is straight. */
  get(h) {
    return this._edges.get(h);
  }

  /** Whether an element has a side that is not straight. */
  bends(e) {
    return this._elements.has(e);
  }

  /** Find them again after a change of the mesh; what has not changed keeps its paths. */
  follow(replica, anew = false) {
    const before = anew ? new Map() : this._edges;
    this._edges = new Map();
    this._elements = new Set();
    const { curves, k, origin, twin, places } = replica;
    if (!curves.count) return;
    const several = replica.regions.length > 1;
    for (let h = 0; h < replica.halfedges; h += 1) {
      if (origin[h] < 0 || (twin[h] >= 0 && !(several && replica.constrained(h)))) continue;
      const curve = curveOf(replica, h);
      if (curve < 0) continue;
      const [from, to] = rangeOf(replica, h, curve);
      if (from === to) continue;
      const [a, b] = [2 * origin[h], 2 * replica.target(h)];
      const ends = [places[a], places[a + 1], places[b], places[b + 1]];
      let edge = before.get(h);
      if (!edge || !edge.equals(curve, from, to, ends)) {
        const pieces = curves.pieces(curve, Math.min(from, to), Math.max(from, to));
        if (pieces.length === 1 && curves.degree(pieces[0].span) === 1) continue;
        edge = new EdgeCurve(curves, curve, from, to, ends);
        if (!edge.bent) continue;
      }
      this._edges.set(h, edge);
      this._elements.add(Math.floor(h / k));
    }
  }
}

/** The curve of an edge on the boundary or an interface, -1 for none; as edge_curve of
 * meshwright_core.core.curve_edges.
 */
function curveOf(replica, h) {
  const { curves, curve, twin } = replica;
  const [a, b] = [replica.origin[h], replica.target(h)];
  if (twin[h] < 0) return curve[a] < curves.count ? curve[a] : -1;
  const { interfaces } = curves;
  const within = (v) => {
    const c = curve[v];
    if (c < 0 || c >= curves.count || interfaces[4 * c] < 0) return false;
    return interfaces[4 * c + 2] !== v && interfaces[4 * c + 3] !== v;
  };
  if (within(a)) return curve[a];
  if (within(b)) return curve[b];
  const own = replica.region[replica.element(h)];
  const other = replica.region[replica.element(twin[h])];
  for (let c = 0; c < curves.count; c += 1) {
    const [left, right, start, end] = interfaces.subarray(4 * c, 4 * c + 4);
    if (left === own && right === other && start === a && end === b) return c;
    if (left === other && right === own && start === b && end === a) return c;
  }
  return -1;
}

/** The parameters on its curve of origin and target of a half-edge; as edge_range there. */
function rangeOf(replica, h, curve) {
  const { curves, parameter } = replica;
  let [first, last] = [replica.origin[h], replica.target(h)];
  const [left, , start, end] = curves.interfaces.subarray(4 * curve, 4 * curve + 4);
  const backward = left >= 0 && replica.region[replica.element(h)] !== left;
  if (backward) [first, last] = [last, first];
  const length = curves.length(curve);
  const low = left >= 0 && start === first ? 0 : parameter[first];
  let high = left >= 0 && end === last ? length : parameter[last];
  if (high <= low && curves.closed[curve]) high += length;
  return backward ? [high, low] : [low, high];
}
