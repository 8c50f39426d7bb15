// The upper canvas: the half-edge that is pointed at, the ghost, the hints. A hover paints this one
// only; where it crosses marks of the mesh they are painted once more above it.

const ARROW_DEPTH = 9;
const ARROW_TRIM = 0.12;
const SMALL_ARROW = 10;
const RING_RADIUS = 10;
const CROWD_OF_MARKS = 300;

class Overlay {
  constructor(canvas, palette, marks) {
    this._canvas = canvas;
    this._pen = canvas.getContext("2d");
    this._palette = palette;
    this._marks = marks;
    this._ratio = 1;
    this._ghosts = new GhostPainter(palette);
    this.badges = new HintBadges(palette);
    this._clear = true;
  }

  /** The canvas has another size in device pixels. */
  resize(width, height, ratio) {
    this._canvas.width = width;
    this._canvas.height = height;
    this._ratio = ratio;
    this._clear = true;
  }

  /** Paint what is pointed at: {halfedge, ghost, title, hints, meant}. */
  paint(view, mirror, facts, shown) {
    const pen = this._pen;
    if (!this._clear) {
      pen.setTransform(1, 0, 0, 1, 0, 0);
      pen.clearRect(0, 0, this._canvas.width, this._canvas.height);
      this._clear = true;
    }
    const pointed = mirror.live(shown.halfedge);
    this.badges.clear();
    if (!pointed && !shown.hints.length) return;
    this._clear = false;
    pen.setTransform(this._ratio, 0, 0, this._ratio, 0, 0);
    pen.lineJoin = "round";
    const marks = this._markPlaces(view, mirror, facts);
    if (pointed) this._paintPointed(pen, view, mirror, facts, shown);
    this.badges.paint(pen, view, mirror, shown.hints, shown.meant, marks);
    marks.push(...this.badges.places);
    if (pointed && shown.ghost) {
      const corners = cornersFrom(mirror, view, shown.halfedge);
      this._ghosts.paintNumbers(pen, view, shown.ghost, shown.title, corners, marks);
    }
  }

  _paintPointed(pen, view, mirror, facts, { halfedge, ghost }) {
    const palette = this._palette;
    const corners = cornersFrom(mirror, view, halfedge);
    pen.globalAlpha = 0.11;
    pen.fillStyle = palette.arrow;
    pen.beginPath();
    corners.forEach((at, i) => (i ? pen.lineTo(...at) : pen.moveTo(...at)));
    pen.closePath();
    pen.fill();
    pen.globalAlpha = 1;
    if (ghost) this._ghosts.paintEdges(pen, view, ghost);
    this._marks.paint(pen, this._ratio, view, mirror, facts, [ghostBounds(view, ghost, corners)]);
    const [tail, head] = arrowOf(mirror, view, halfedge);
    paintArrow(pen, tail, head, palette.arrow, palette.background);
    const length = Math.hypot(head[0] - tail[0], head[1] - tail[1]);
    if (length < SMALL_ARROW) this._paintRing(pen, middleOf([tail, head]));
  }

  /** A ring that is found where the arrow itself is too small to be seen. */
  _paintRing(pen, [x, y]) {
    for (const [colour, width] of [[this._palette.background, 4.5], [this._palette.arrow, 2]]) {
      pen.strokeStyle = colour;
      pen.lineWidth = width;
      pen.beginPath();
      pen.arc(x, y, RING_RADIUS, 0, 2 * Math.PI);
      pen.stroke();
    }
  }

  /** Places of irregular vertices on the screen, unless they are everywhere. */
  _markPlaces(view, mirror, facts) {
    if (facts.irregular.length > 10 * CROWD_OF_MARKS) return [];
    const places = facts.irregular.map((v) => view.toScreen(...mirror.place(v)));
    const seen = places.filter(([x, y]) => x > 0 && y > 0 && x < view.width && y < view.height);
    return seen.length > CROWD_OF_MARKS ? [] : seen;
  }
}

/** Corners of a half-edge's element on the screen, from its origin on. */
function cornersFrom(mirror, view, halfedge) {
  const corners = [];
  let h = halfedge;
  for (let i = 0; i < mirror.k; i += 1) {
    corners.push(view.toScreen(...mirror.place(mirror.origin[h])));
    h = mirror.next(h);
  }
  return corners;
}

/** Tail and head of the arrow just inside the element of a half-edge, on the screen. */
function arrowOf(mirror, view, halfedge) {
  const corners = cornersFrom(mirror, view, halfedge);
  const [cx, cy] = middleOf(corners);
  const [mx, my] = middleOf(corners.slice(0, 2));
  const share = Math.min(0.22, ARROW_DEPTH / Math.max(Math.hypot(cx - mx, cy - my), 1e-6));
  const [a, b] = corners.slice(0, 2).map(([x, y]) => [x + (cx - x) * share, y + (cy - y) * share]);
  const trim = [ARROW_TRIM * (b[0] - a[0]), ARROW_TRIM * (b[1] - a[1])];
  return [[a[0] + trim[0], a[1] + trim[1]], [b[0] - trim[0], b[1] - trim[1]]];
}

/** A line with a head, with a halo. */
function paintArrow(pen, tail, head, colour, halo) {
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
