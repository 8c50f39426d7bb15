// The arrow of a half-edge, drawn just inside its element.

import { middleOf } from "../mesh/picking.js";
import { sidePoint } from "../mesh/sides.js";
import { clamp } from "../numbers.js";

const ARROW_DEPTH = 9;
const ARROW_TRIM = 0.12;
/** The largest depth of an arrow along a curve, relative to the length of its side. */
const NARROW = 0.3;
/** Fewest and most points of half an arrow along a curve, and pixels from one to the next. */
const FEWEST = 12;
const MOST = 150;
const STEP = 12;

/** Corners of a half-edge's element on the screen, from its origin on. */
export function cornersFrom(replica, view, halfedge) {
  const corners = [];
  let h = halfedge;
  for (let i = 0; i < replica.k; i += 1) {
    corners.push(view.toScreen(...replica.place(replica.origin[h])));
    h = replica.next(h);
  }
  return corners;
}

/** The arrow just inside the element of a half-edge as points on the screen from tail to head: two,
 * or more where the element has curved sides.
 */
export function arrowOf(replica, view, halfedge) {
  if (replica.edgeCurves.bends(replica.element(halfedge))) return curvedArrow(replica, view, halfedge);
  const corners = cornersFrom(replica, view, halfedge);
  const [cx, cy] = middleOf(corners);
  const [mx, my] = middleOf(corners.slice(0, 2));
  const share = Math.min(0.22, ARROW_DEPTH / Math.max(Math.hypot(cx - mx, cy - my), 1e-6));
  const [a, b] = corners.slice(0, 2).map(([x, y]) => [x + (cx - x) * share, y + (cy - y) * share]);
  const trim = [ARROW_TRIM * (b[0] - a[0]), ARROW_TRIM * (b[1] - a[1])];
  return [[a[0] + trim[0], a[1] + trim[1]], [b[0] - trim[0], b[1] - trim[1]]];
}

/** The middle of an arrow. */
export function arrowMiddle(points) {
  return points.length % 2 ? points[points.length >> 1] : middleOf([points[0], points[points.length - 1]]);
}

function curvedArrow(replica, view, halfedge) {
  const inner = innerPoint(replica, view, halfedge);
  const along = (v, trim, half) => Array.from({ length: 2 * half + 1 }, (_, i) =>
    inner(trim + (i / (2 * half)) * (1 - 2 * trim), v));
  const length = lengthOf(along(0, 0, FEWEST));
  const depth = Math.max(lengthOf([inner(0.5, 0), inner(0.5, 1)]) / 2, 1e-6);
  // in a narrow element nearer to its own side than to those beside it
  const wanted = Math.min(ARROW_DEPTH, NARROW * length);
  const v = Math.min(0.22, wanted / depth) / 2;
  return along(v, v + ARROW_TRIM * (1 - 2 * v), Math.round(clamp(length / STEP / 2, FEWEST, MOST)));
}

/** A function that gives the point at (u, v) in an element, on the screen: v = 0 is the half-edge,
 * v = 1 the opposite side or corner. Of a quad it is the Coons map.
 */
function innerPoint(replica, view, halfedge) {
  const right = replica.next(halfedge);
  const left = replica.prev(halfedge);
  const at = (h, w) => view.toScreen(...sidePoint(replica, h, w));
  const top = (u) => (replica.k === 4 ? at(replica.next(right), 1 - u) : at(left, 0));
  const [p, q, r, s] = [at(halfedge, 0), at(halfedge, 1), at(right, 1), at(left, 0)];
  return (u, v) => {
    const [bottom, above, before, after] = [at(halfedge, u), top(u), at(left, 1 - v), at(right, v)];
    return [0, 1].map((c) => (1 - v) * bottom[c] + v * above[c] + (1 - u) * before[c] + u * after[c]
      - (1 - u) * (1 - v) * p[c] - u * (1 - v) * q[c] - u * v * r[c] - (1 - u) * v * s[c]);
  };
}

/** Paint a line of points with an arrow head and a halo. */
export function paintArrow(pen, points, colour, halo) {
  const head = points[points.length - 1];
  const length = lengthOf(points);
  if (length < 1) return;
  const size = Math.min(9, 0.45 * length);
  const shaft = shortened(points, 0.8 * size);
  const root = shortened(points, size).pop();
  const reach = Math.max(Math.hypot(head[0] - root[0], head[1] - root[1]), 1e-9);
  const [ux, uy] = [(head[0] - root[0]) / reach, (head[1] - root[1]) / reach];
  const line = (width, stroke) => {
    pen.strokeStyle = stroke;
    pen.lineWidth = width;
    pen.beginPath();
    shaft.forEach((at, i) => (i ? pen.lineTo(...at) : pen.moveTo(...at)));
    pen.stroke();
  };
  pen.lineCap = "round";
  line(Math.min(5, 0.5 * size + 0.5), halo);
  line(Math.min(2.25, 0.25 * size + 0.4), colour);
  const [x, y] = root;
  pen.fillStyle = colour;
  pen.beginPath();
  pen.moveTo(...head);
  pen.lineTo(x - uy * 0.5 * size, y + ux * 0.5 * size);
  pen.lineTo(head[0] - ux * 0.72 * size, head[1] - uy * 0.72 * size);
  pen.lineTo(x + uy * 0.5 * size, y - ux * 0.5 * size);
  pen.closePath();
  pen.fill();
}

/** The length of a polyline. */
export function lengthOf(points) {
  let length = 0;
  for (let i = 1; i < points.length; i += 1) {
    length += Math.hypot(points[i][0] - points[i - 1][0], points[i][1] - points[i - 1][1]);
  }
  return length;
}

/** A polyline without its last `length`. */
function shortened(points, length) {
  let left = length;
  for (let i = points.length - 1; i > 0; i -= 1) {
    const [[ax, ay], [bx, by]] = [points[i - 1], points[i]];
    const step = Math.hypot(bx - ax, by - ay);
    if (step > left) {
      const share = left / step;
      return [...points.slice(0, i), [bx + share * (ax - bx), by + share * (ay - by)]];
    }
    left -= step;
  }
  return [points[0], points[0]];
}
