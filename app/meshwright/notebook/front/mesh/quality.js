// Measures of elements. Straight ones are measured here; values of those with curved sides come from
// Python, with the head of a message.

const IDEAL = { 3: Math.sqrt(0.75), 4: 1 };

/** The values of curved elements: Map of element to [scaled Jacobian, shape]. */
export function curvedValues(head) {
  return new Map(((head && head.curved) || []).map(([e, jacobian, shape]) => [e, [jacobian, shape]]));
}

/** Scaled Jacobian ("jacobian") or shape ("shape") of an element, 1 for the best. */
export function qualityOf(replica, e, measure, curved) {
  const known = curved.get(e);
  if (known) return known[measure === "jacobian" ? 0 : 1];
  const { k, origin, places } = replica;
  let worst = Infinity;
  for (let i = 0; i < (measure === "shape" && k === 3 ? 1 : k); i += 1) {
    const [o, s, t] = [i, (i + 1) % k, (i + k - 1) % k].map((corner) => 2 * origin[k * e + corner]);
    const [px, py] = [places[s] - places[o], places[s + 1] - places[o + 1]];
    const [qx, qy] = [places[t] - places[o], places[t + 1] - places[o + 1]];
    const [pp, qq, det] = [px * px + py * py, qx * qx + qy * qy, px * qy - py * qx];
    worst = Math.min(worst, measure === "jacobian"
      ? det / (Math.sqrt(pp * qq) || 1) / IDEAL[k]
      : shapeAt(k, det, pp, qq, (px - qx) ** 2 + (py - qy) ** 2));
  }
  return worst;
}

function shapeAt(k, det, pp, qq, third) {
  const squares = k === 3 ? pp + qq + third : pp + qq;
  return squares > 0 ? ((k === 3 ? Math.sqrt(3) : 1) * 2 * det) / squares : 0;
}
