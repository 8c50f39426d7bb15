// Composite curves: chains of rational Bezier spans, as meshwright_core.core.composite_curves.
//
// A curve's parameter t runs from 0 to its length; it is linear in the Bezier parameter u of each
// span. Coordinates are float64, in the normalised frame of the state message.

import { arrayOf } from "./typed_arrays.js";

/** Buffers of a state message that hold curves. */
export const CURVE_BUFFERS = 7;

export class Curves {
  /** The curves in buffers: control (c, 3) [w x, w y, w], first control of each span (s + 1),
   * start and stop (s) of its parameters, first span of each curve (n + 1), closed (n), and
   * interfaces (n, 4): regions on the left and on the right, first and last vertex; -1 for none.
   */
  constructor(buffers = []) {
    const take = (Type, i) => (buffers[i] ? arrayOf(Type, buffers[i]) : new Type(0));
    this._control = take(Float64Array, 0);
    this._firstControl = take(Int32Array, 1);
    this._start = take(Float64Array, 2);
    this._stop = take(Float64Array, 3);
    this._firstSpan = take(Int32Array, 4);
    this.closed = take(Uint8Array, 5);
    this.interfaces = take(Int32Array, 6);
    this.buffers = buffers;
  }

  /** Number of curves. */
  get count() {
    return this.closed.length;
  }

  /** The largest parameter of a curve. */
  length(curve) {
    return this._stop[this._firstSpan[curve + 1] - 1];
  }

  /** Write the point at t of a curve to out[at], out[at + 1]; beyond an open end: straight on. */
  place(curve, t, out, at = 0) {
    const length = this.length(curve);
    let turned = t;
    if (this.closed[curve] && (t < 0 || t > length)) turned = t - Math.floor(t / length) * length;
    const inside = Math.min(Math.max(turned, 0), length);
    const span = this._spanAt(curve, inside);
    const extent = this._stop[span] - this._start[span];
    this.placeInSpan(span, (inside - this._start[span]) / extent, out, at);
    if (inside !== turned) {
      const [x, y] = this._slope(span, inside > 0 ? 1 : 0);
      out[at] += ((turned - inside) / extent) * x;
      out[at + 1] += ((turned - inside) / extent) * y;
    }
  }

  /** Write the point at u in [0, 1] of a span to out[at], out[at + 1]. */
  placeInSpan(span, u, out, at) {
    const first = 3 * this._firstControl[span];
    const degree = this.degree(span);
    const control = this._control;
    if (degree === 1) {
      for (let c = 0; c < 2; c += 1) {
        const step = control[first + 3 + c] - control[first + c];
        // from the nearer end, so that both ends are met to the bit
        out[at + c] = u <= 0.5 ? control[first + c] + u * step : control[first + 3 + c] - (1 - u) * step;
      }
      return;
    }
    const weight = bernstein(control, first + 2, degree, u);
    out[at] = bernstein(control, first, degree, u) / weight;
    out[at + 1] = bernstein(control, first + 1, degree, u) / weight;
  }

  degree(span) {
    return this._firstControl[span + 1] - this._firstControl[span] - 1;
  }

  /** The pieces of spans between parameters low < high <= 2 length of a curve, in order:
   * [{span, from, to}], `from` and `to` in [0, 1]. */
  pieces(curve, low, high) {
    const length = this.length(curve);
    const found = [];
    let turn = low >= length ? length : 0;
    let span = this._spanAt(curve, low - turn);
    while (turn + this._start[span] < high && found.length < this._start.length * 2 + 2) {
      const [start, extent] = [turn + this._start[span], this._stop[span] - this._start[span]];
      const from = Math.max((low - start) / extent, 0);
      const to = Math.min((high - start) / extent, 1);
      if (from < to) found.push({ span, from, to, start, extent });
      span += 1;
      if (span === this._firstSpan[curve + 1]) {
        if (!this.closed[curve]) break;
        span = this._firstSpan[curve];
        turn += length;
      }
    }
    return found;
  }

  /** The span of a curve at t in [0, length], by bisection. */
  _spanAt(curve, t) {
    let [low, high] = [this._firstSpan[curve], this._firstSpan[curve + 1]];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this._start[middle] <= t) low = middle;
      else high = middle;
    }
    return low;
  }

  /** Derivative by u at an end of a span, u = 0 or 1. */
  _slope(span, u) {
    const degree = this.degree(span);
    const end = 3 * (this._firstControl[span] + u * degree);
    const by = end + (u ? -3 : 3);
    const control = this._control;
    const share = (degree * control[by + 2]) / control[end + 2] * (u ? -1 : 1);
    return [0, 1].map((c) => share * (control[by + c] / control[by + 2] - control[end + c] / control[end + 2]));
  }
}

/** One coordinate, `at`, at +3, ... of the Bezier curve of this degree, with Horner's scheme. */
function bernstein(control, at, degree, u) {
  const v = 1 - u;
  let power = 1;
  let binomial = 1;
  let total = control[at] * v;
  for (let i = 1; i < degree; i += 1) {
    power *= u;
    binomial *= (degree - i + 1) / i;
    total = (total + power * binomial * control[at + 3 * i]) * v;
  }
  return total + power * u * control[at + 3 * degree];
}
