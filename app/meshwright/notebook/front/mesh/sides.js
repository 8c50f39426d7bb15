// The sides of elements as they are: straight, or pieces of curves.

import { emptyBox, enlarge, enclose } from "./boxes.js";
import { COARSE } from "./edge_curves.js";

/** Points [x, y, x, y, ...] of a half-edge from its origin to its target, within `tolerance`. */
export function sidePath(replica, h, tolerance = COARSE) {
  const edge = replica.edgeCurves.get(h);
  if (edge) return edge.path(tolerance);
  const [a, b] = [2 * replica.origin[h], 2 * replica.target(h)];
  const { places } = replica;
  return [places[a], places[a + 1], places[b], places[b + 1]];
}

/** The point [x, y] at w in [0, 1] of a half-edge. */
export function sidePoint(replica, h, w) {
  const edge = replica.edgeCurves.get(h);
  if (edge) return edge.point(w);
  const [a, b] = [replica.place(replica.origin[h]), replica.place(replica.target(h))];
  return [a[0] + w * (b[0] - a[0]), a[1] + w * (b[1] - a[1])];
}

/** The polygon [[x, y], ...] of an element within `tolerance`, from the origin of `halfedge` on. */
export function outlineFrom(replica, halfedge, tolerance = COARSE) {
  const points = [];
  let h = halfedge;
  for (let i = 0; i < replica.k; i += 1) {
    const path = sidePath(replica, h, tolerance);
    for (let j = 0; j < path.length - 2; j += 2) points.push([path[j], path[j + 1]]);
    h = replica.next(h);
  }
  return points;
}

/** A point [x, y] in the middle of an element: the mean of its corners if its sides are straight. */
export function middleOfElement(replica, e) {
  let [x, y] = [0, 0];
  const { k } = replica;
  const add = ([px, py], weight) => {
    x += (weight * px) / k;
    y += (weight * py) / k;
  };
  const bent = replica.edgeCurves.bends(e);
  for (let h = k * e; h < k * e + k; h += 1) {
    // of a quad the middle of its Coons map, which the middles of its sides pull
    add(replica.place(replica.origin[h]), bent ? -1 : 1);
    if (bent) add(sidePoint(replica, h, 0.5), 2);
  }
  return [x, y];
}

/** {left, bottom, right, top} of an element, null if it is dead. */
export function boxOf(replica, e) {
  const { k, origin, places, edgeCurves } = replica;
  if (!replica.live(k * e)) return null;
  const box = emptyBox();
  for (let h = k * e; h < k * e + k; h += 1) enclose(box, places[2 * origin[h]], places[2 * origin[h] + 1]);
  if (edgeCurves.bends(e)) {
    for (let h = k * e; h < k * e + k; h += 1) {
      const edge = edgeCurves.get(h);
      if (edge) enlarge(box, edge.box);
    }
  }
  return box;
}
