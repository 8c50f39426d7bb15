// Paints the upper canvas: current half-edge, preview, hints. Hovering repaints this canvas only;
// markers of the mesh under the preview are painted again above it.

import { outlineFrom } from "../mesh/sides.js";
import { arrowMiddle, arrowOf, cornersFrom, lengthOf, paintArrow } from "./arrow.js";
import { BlocksLayer } from "./blocks_layer.js";
import { ghostBounds, GhostPainter } from "./ghost.js";
import { HintBadges } from "./hint_badges.js";
import { DEVIATION } from "./mesh_painter.js";

const SMALL_ARROW = 10;
const RING_RADIUS = 10;
const CROWD_OF_MARKS = 300;

export class Overlay {
  constructor(canvas, colours, marks) {
    this._canvas = canvas;
    this._pen = canvas.getContext("2d");
    this._colours = colours;
    this._markers = marks;
    this._ratio = 1;
    this._ghosts = new GhostPainter(colours);
    this.badges = new HintBadges(colours);
    this.blocks = new BlocksLayer(colours);
    this._clear = true;
  }

  /** The canvas has another size in device pixels. */
  resize(width, height, ratio) {
    this._canvas.width = width;
    this._canvas.height = height;
    this._ratio = ratio;
    this._clear = true;
  }

  /** Paint blocks, half-edge, preview and hints: {blocks, chord, halfedge, ghost, title, hints,
   * selected}.
   */
  paint(view, replica, derived, shown) {
    const pen = this._pen;
    if (!this._clear) {
      pen.setTransform(1, 0, 0, 1, 0, 0);
      pen.clearRect(0, 0, this._canvas.width, this._canvas.height);
      this._clear = true;
    }
    const pointed = replica.live(shown.halfedge);
    this.badges.clear();
    this.blocks.clear();
    if (!pointed && !shown.hints.length && !shown.blocks) return;
    this._clear = false;
    pen.setTransform(this._ratio, 0, 0, this._ratio, 0, 0);
    pen.lineJoin = "round";
    if (shown.blocks) this.blocks.paint(pen, view, shown.blocks, shown.chord);
    const marks = this._markPlaces(view, replica, derived);
    if (pointed) this._paintPointed(pen, view, replica, derived, shown);
    this.badges.paint(pen, view, replica, shown.hints, shown.selected, marks);
    marks.push(...this.badges.places);
    if (pointed && shown.ghost) {
      const corners = cornersFrom(replica, view, shown.halfedge);
      this._ghosts.paintNumbers(pen, view, shown.ghost, shown.title, corners, marks);
    }
  }

  _paintPointed(pen, view, replica, derived, { halfedge, ghost }) {
    const colours = this._colours;
    const corners = cornersFrom(replica, view, halfedge);
    pen.globalAlpha = 0.11;
    pen.fillStyle = colours.arrow;
    pen.beginPath();
    const outline = outlineFrom(replica, halfedge, DEVIATION / (view.pixels * this._ratio));
    outline.forEach(([x, y], i) => (i ? pen.lineTo(...view.toScreen(x, y)) : pen.moveTo(...view.toScreen(x, y))));
    pen.closePath();
    pen.fill();
    pen.globalAlpha = 1;
    if (ghost) this._ghosts.paintEdges(pen, view, ghost, colours.fillOf(replica, halfedge));
    this._markers.paint(pen, this._ratio, view, replica, derived, [ghostBounds(view, ghost, corners)]);
    const arrow = arrowOf(replica, view, halfedge);
    paintArrow(pen, arrow, colours.arrow, colours.background);
    if (lengthOf(arrow) < SMALL_ARROW) this._paintRing(pen, arrowMiddle(arrow));
  }

  /** A ring around an arrow that is too small to be seen. */
  _paintRing(pen, [x, y]) {
    for (const [colour, width] of [[this._colours.background, 4.5], [this._colours.arrow, 2]]) {
      pen.strokeStyle = colour;
      pen.lineWidth = width;
      pen.beginPath();
      pen.arc(x, y, RING_RADIUS, 0, 2 * Math.PI);
      pen.stroke();
    }
  }

  /** Irregular vertices on the screen as points, unless there are too many. */
  _markPlaces(view, replica, derived) {
    if (derived.irregular.length > 10 * CROWD_OF_MARKS) return [];
    const places = derived.irregular.map((v) => view.toScreen(...replica.place(v)));
    const seen = places.filter(([x, y]) => x > 0 && y > 0 && x < view.width && y < view.height);
    return seen.length > CROWD_OF_MARKS ? [] : seen;
  }
}
