// The arrow of a half-edge, drawn just inside its element.

import { middleOf } from "../mesh/picking.js";

const ARROW_DEPTH = 9;
const ARROW_TRIM = 0.12;

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

/** Tail and head of the arrow just inside the element of a half-edge, on the screen. */
export function arrowOf(replica, view, halfedge) {
  const corners = cornersFrom(replica, view, halfedge);
  const [cx, cy] = middleOf(corners);
  const [mx, my] = middleOf(corners.slice(0, 2));
  const share = Math.min(0.22, ARROW_DEPTH / Math.max(Math.hypot(cx - mx, cy - my), 1e-6));
  const [a, b] = corners.slice(0, 2).map(([x, y]) => [x + (cx - x) * share, y + (cy - y) * share]);
  const trim = [ARROW_TRIM * (b[0] - a[0]), ARROW_TRIM * (b[1] - a[1])];
  return [[a[0] + trim[0], a[1] + trim[1]], [b[0] - trim[0], b[1] - trim[1]]];
}

/** Paint a line with an arrow head and a halo. */
export function paintArrow(pen, tail, head, colour, halo) {
  const length = Math.hypot(head[0] - tail[0], head[1] - tail[1]);
  if (length < 1) return;
  const [ux, uy] = [(head[0] - tail[0]) / length, (head[1] - tail[1]) / length];
  const size = Math.min(9, 0.45 * length);
  const back = (share) => [head[0] - ux * share * size, head[1] - uy * share * size];
  const line = (width, stroke) => {
    pen.strokeStyle = stroke;
    pen.lineWidth = width;
    pen.beginPath();
    pen.moveTo(...tail);
    pen.lineTo(...back(0.8));
    pen.stroke();
  };
  pen.lineCap = "round";
  line(Math.min(5, 0.5 * size + 0.5), halo);
  line(Math.min(2.25, 0.25 * size + 0.4), colour);
  const [x, y] = back(1);
  pen.fillStyle = colour;
  pen.beginPath();
  pen.moveTo(...head);
  pen.lineTo(x - uy * 0.5 * size, y + ux * 0.5 * size);
  pen.lineTo(...back(0.72));
  pen.lineTo(x + uy * 0.5 * size, y - ux * 0.5 * size);
  pen.closePath();
  pen.fill();
}
