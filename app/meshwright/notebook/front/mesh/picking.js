// Which half-edge or vertex lies at a point of the plane.

import { clamp } from "../numbers.js";

/** The half-edge of the element at (x, y) whose edge is nearest; outside the mesh the one of the
 * boundary within `reach` lengths; -1 for none.
 */
export function halfedgeAt(mirror, grid, x, y, reach) {
  for (const e of grid.near(x, y, x, y)) {
    if (contains(mirror, e, x, y)) return nearestSide(mirror, e, x, y).halfedge;
  }
  let best = { halfedge: -1, away: reach };
  for (const e of grid.near(x - reach, y - reach, x + reach, y + reach)) {
    for (let h = mirror.k * e; h < mirror.k * (e + 1); h += 1) {
      if (mirror.twin[h] >= 0) continue;
      const away = distanceToEdge(mirror, h, x, y);
      if (away < best.away) best = { halfedge: h, away };
    }
  }
  return best.halfedge;
}

/** The vertex nearest to (x, y) within `reach` lengths, as a half-edge that starts there; or -1. */
export function vertexAt(mirror, grid, x, y, reach) {
  let best = -1;
  let least = reach;
  for (const e of grid.near(x - reach, y - reach, x + reach, y + reach)) {
    for (let h = mirror.k * e; h < mirror.k * (e + 1); h += 1) {
      const [px, py] = mirror.place(mirror.origin[h]);
      const away = Math.hypot(px - x, py - y);
      if (away < least) [best, least] = [h, away];
    }
  }
  return best;
}

/** The half-edge whose element is nearest to (x, y), wherever that is; -1 in an empty mesh. */
export function halfedgeNear(mirror, x, y) {
  let best = -1;
  let least = Infinity;
  for (let e = 0; e < mirror.elements; e += 1) {
    if (mirror.origin[mirror.k * e] < 0) continue;
    const [px, py] = middleOf(mirror.corners(e));
    const away = Math.hypot(px - x, py - y);
    if (away < least) [best, least] = [mirror.k * e, away];
  }
  return best < 0 ? -1 : nearestSide(mirror, best / mirror.k, x, y).halfedge;
}

function contains(mirror, e, x, y) {
  let inside = false;
  for (let h = mirror.k * e; h < mirror.k * (e + 1); h += 1) {
    const [ax, ay] = mirror.place(mirror.origin[h]);
    const [bx, by] = mirror.place(mirror.target(h));
    if (ay > y !== by > y && x < ax + ((y - ay) * (bx - ax)) / (by - ay)) inside = !inside;
  }
  return inside;
}

function nearestSide(mirror, e, x, y) {
  let best = { halfedge: mirror.k * e, away: Infinity };
  for (let h = mirror.k * e; h < mirror.k * (e + 1); h += 1) {
    const away = distanceToEdge(mirror, h, x, y);
    if (away < best.away) best = { halfedge: h, away };
  }
  return best;
}

function distanceToEdge(mirror, h, x, y) {
  const [ax, ay] = mirror.place(mirror.origin[h]);
  const [bx, by] = mirror.place(mirror.target(h));
  const [ux, uy] = [bx - ax, by - ay];
  const share = clamp(((x - ax) * ux + (y - ay) * uy) / Math.max(ux * ux + uy * uy, 1e-30), 0, 1);
  return Math.hypot(ax + share * ux - x, ay + share * uy - y);
}

/** The mean of some points. */
export function middleOf(points) {
  const sum = points.reduce(([x, y], [px, py]) => [x + px, y + py], [0, 0]);
  return [sum[0] / points.length, sum[1] / points.length];
}
