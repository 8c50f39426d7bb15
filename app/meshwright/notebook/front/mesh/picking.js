// Finds the half-edge or vertex at a point of the plane.

import { awayFromChord, COARSE } from "./edge_curves.js";
import { middleOfElement, sidePath } from "./sides.js";

/** The nearest half-edge of the element at (x, y); outside of the mesh the nearest boundary half-edge
 * within distance `reach`; -1 for none. Curves are followed within `tolerance`.
 */
export function halfedgeAt(replica, grid, x, y, reach, tolerance) {
  for (const e of grid.near(x, y, x, y)) {
    if (contains(replica, e, x, y, tolerance)) return nearestSide(replica, e, x, y, tolerance).halfedge;
  }
  let best = { halfedge: -1, away: reach };
  for (const e of grid.near(x - reach, y - reach, x + reach, y + reach)) {
    for (let h = replica.k * e; h < replica.k * (e + 1); h += 1) {
      if (replica.twin[h] >= 0) continue;
      const away = distanceToEdge(replica, h, x, y, tolerance);
      if (away < best.away) best = { halfedge: h, away };
    }
  }
  return best.halfedge;
}

/** The nearest vertex within distance `reach` of (x, y), as a half-edge that starts there; or -1. */
export function vertexAt(replica, grid, x, y, reach) {
  let best = -1;
  let least = reach;
  for (const e of grid.near(x - reach, y - reach, x + reach, y + reach)) {
    for (let h = replica.k * e; h < replica.k * (e + 1); h += 1) {
      const [px, py] = replica.place(replica.origin[h]);
      const away = Math.hypot(px - x, py - y);
      if (away < least) [best, least] = [h, away];
    }
  }
  return best;
}

/** The half-edge whose element is nearest to (x, y), at any distance; -1 in an empty mesh. */
export function halfedgeNear(replica, x, y) {
  let best = -1;
  let least = Infinity;
  for (let e = 0; e < replica.elements; e += 1) {
    if (replica.origin[replica.k * e] < 0) continue;
    const [px, py] = middleOfElement(replica, e);
    const away = Math.hypot(px - x, py - y);
    if (away < least) [best, least] = [replica.k * e, away];
  }
  return best < 0 ? -1 : nearestSide(replica, best / replica.k, x, y).halfedge;
}

function contains(replica, e, x, y, tolerance) {
  let inside = false;
  for (let h = replica.k * e; h < replica.k * (e + 1); h += 1) {
    const path = sidePath(replica, h, tolerance);
    for (let i = 3; i < path.length; i += 2) {
      const [ax, ay, bx, by] = [path[i - 3], path[i - 2], path[i - 1], path[i]];
      if (ay > y !== by > y && x < ax + ((y - ay) * (bx - ax)) / (by - ay)) inside = !inside;
    }
  }
  return inside;
}

function nearestSide(replica, e, x, y, tolerance = COARSE) {
  let best = { halfedge: replica.k * e, away: Infinity };
  for (let h = replica.k * e; h < replica.k * (e + 1); h += 1) {
    const away = distanceToEdge(replica, h, x, y, tolerance);
    if (away < best.away) best = { halfedge: h, away };
  }
  return best;
}

function distanceToEdge(replica, h, x, y, tolerance) {
  const path = sidePath(replica, h, tolerance);
  let least = Infinity;
  for (let i = 3; i < path.length; i += 2) {
    least = Math.min(least, awayFromChord(path[i - 3], path[i - 2], path[i - 1], path[i], x, y));
  }
  return least;
}

/** The mean of some points. */
export function middleOf(points) {
  const sum = points.reduce(([x, y], [px, py]) => [x + px, y + py], [0, 0]);
  return [sum[0] / points.length, sum[1] / points.length];
}
