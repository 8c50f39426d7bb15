// Boxes {left, bottom, right, top} of the plane.

/** A box of nothing. */
export function emptyBox() {
  return { left: Infinity, bottom: Infinity, right: -Infinity, top: -Infinity };
}

/** Enlarge a box until it holds (x, y). */
export function enclose(box, x, y) {
  if (x < box.left) box.left = x;
  if (x > box.right) box.right = x;
  if (y < box.bottom) box.bottom = y;
  if (y > box.top) box.top = y;
}

/** Enlarge a box until it holds another one. */
export function enlarge(box, other) {
  enclose(box, other.left, other.bottom);
  enclose(box, other.right, other.top);
}

/** Whether two boxes share a point. */
export function overlap(a, b) {
  return a.left <= b.right && b.left <= a.right && a.bottom <= b.top && b.bottom <= a.top;
}
