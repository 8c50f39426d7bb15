// The stage: two canvases, the view of the mesh, and the scheduling of paints.

import { node } from "../dom.js";
import { MeshState } from "../mesh/mesh_state.js";
import { halfedgeAt, vertexAt } from "../mesh/picking.js";
import { clamp } from "../numbers.js";
import { arrowMiddle, arrowOf } from "./arrow.js";
import { Markers } from "./markers.js";
import { DEVIATION, MeshPainter } from "./mesh_painter.js";
import { Overlay } from "./overlay.js";
import { Viewport } from "./viewport.js";

const FIT_SHARE = 0.08;
const FIT_MOST = 48;
const FIT_LEAST = 22;
/** Pixels by which a curve may deviate where it is pointed at. */
const PICKED = 0.25;

export class Stage {
  constructor(element, colours, painted) {
    this.element = element;
    this.meshState = new MeshState();
    this.view = new Viewport();
    this.fitted = true; // the view was not moved: it keeps fitting the mesh
    this.shown = {
      halfedge: -1, ghost: null, title: "", hints: [], selected: 0, blocks: null, chord: -1,
    };
    this._colours = colours;
    this._painted = painted;
    this._lower = node("canvas", "mw-lower", { "aria-hidden": "true" });
    this.surface = node("canvas", "mw-upper", { tabindex: "0", role: "application" });
    element.append(this._lower, this.surface);
    this._markers = new Markers(colours);
    this.painter = new MeshPainter(this._lower, colours, this._markers, () => this.repaint());
    this.overlay = new Overlay(this.surface, colours, this._markers);
    this._ratio = 0;
    this._frame = 0;
    this._observer = new ResizeObserver(() => this.resize());
    this._observer.observe(element);
  }

  release() {
    this._observer.disconnect();
    cancelAnimationFrame(this._frame);
    this.painter.release();
  }

  // The mesh

  load(content, buffers) {
    const before = this.meshState.replica.frame;
    const first = this.meshState.replica.revision < 0;
    this.meshState.load(content, buffers);
    const moved = ["cx", "cy", "scale"].some((name) => before[name] !== content.frame[name]);
    if (first || moved) this.fitted = true;
    this.painter.forget();
    this._show();
  }

  /** Apply a patch; returns false if it is not for the present revision. */
  patch(content, buffers) {
    const boxes = this.meshState.patch(content, buffers);
    if (boxes === undefined) return false;
    if (boxes) this.painter.touch(boxes);
    else this.painter.forget();
    this._show();
    return true;
  }

  _show() {
    const { replica, derived, grid } = this.meshState;
    this.painter.show(replica, derived, grid);
    if (this.fitted) this._fit();
    this.repaint();
  }

  // The view

  /** Set the view; its centre is kept over the mesh. */
  see(view) {
    this.view = view.over(this.meshState.derived.box);
    this.fitted = false;
    this.repaint();
  }

  /** Fit the mesh into the view. */
  fit() {
    this.fitted = true;
    this._fit();
    this.repaint();
  }

  _fit() {
    const { box } = this.meshState.derived;
    const { width, height } = this.view;
    const margin = clamp(FIT_SHARE * Math.min(width, height), FIT_LEAST, FIT_MOST);
    if (box) this.view = this.view.fitted(box, margin);
  }

  /** Adapt to the size and pixel ratio of the element. */
  resize() {
    const ratio = globalThis.devicePixelRatio || 1;
    const [width, height] = [this.element.clientWidth, this.element.clientHeight];
    if (!width || !height) return;
    const [across, down] = [Math.floor(width * ratio), Math.floor(height * ratio)];
    const same = across === this._lower.width && down === this._lower.height && ratio === this._ratio;
    if (same) return;
    this._ratio = ratio;
    for (const canvas of [this._lower, this.surface]) {
      canvas.style.width = `${across / ratio}px`;
      canvas.style.height = `${down / ratio}px`;
    }
    this.painter.resize(across, down, ratio);
    this.overlay.resize(across, down, ratio);
    this.view = this.view.resized(across / ratio, down / ratio);
    if (this.fitted) this._fit();
    this.paint(); // resizing clears a canvas
  }

  /** Greatest deviation of painted curves, in the plane. */
  get tolerance() {
    return DEVIATION / (this.view.pixels * (this._ratio || 1));
  }

  pan(dx, dy) {
    this.see(this.view.panned(dx, dy));
  }

  /** Zoom in by `factor` at (x, y), by default in the middle. */
  zoom(factor, x = this.view.width / 2, y = this.view.height / 2) {
    this.see(this.view.zoomed(factor, x, y));
  }

  /** Zoom in at a point until `reach` around it is `least` pixels wide. */
  reveal(x, y, reach, least) {
    if (this.view.pixels * 2 * reach < least) this.see(this.view.around(x, y, reach, least));
  }

  /** Pan until a half-edge lies `margin` pixels inside the canvas. */
  keepInView(halfedge, margin) {
    const [x, y] = this.middle(halfedge);
    const { width, height } = this.view;
    const [keepX, keepY] = [Math.min(margin, width / 3), Math.min(margin, height / 3)];
    const [dx, dy] = [clamp(x, keepX, width - keepX) - x, clamp(y, keepY, height - keepY) - y];
    if (dx || dy) this.pan(dx, dy);
  }

  /** The middle of a half-edge's arrow on the canvas. */
  middle(halfedge) {
    return arrowMiddle(arrowOf(this.meshState.replica, this.view, halfedge));
  }

  // Painting

  /** Repaint after a change of colours. */
  recolour() {
    this._markers.forget();
    this.painter.forget();
    this.repaint();
  }

  /** Colour elements by "jacobian" or "shape"; by nothing for "". */
  colourBy(measure) {
    this.painter.measure = measure;
    this.painter.forget();
    this.repaint();
  }

  /** Schedule a paint for the next frame. */
  repaint() {
    if (!this._frame) this._frame = requestAnimationFrame(() => this.paint());
  }

  paint() {
    cancelAnimationFrame(this._frame);
    this._frame = 0;
    const { replica, derived } = this.meshState;
    if (replica.revision < 0 || !this._lower.width || !this._colours.theme) return;
    if ((globalThis.devicePixelRatio || 1) !== this._ratio) {
      this.resize();
      return;
    }
    this.painter.paint(this.view);
    this.overlay.paint(this.painter.view, replica, derived, this.shown);
    this._painted();
  }

  /** The half-edge at [x, y] of the canvas, or of the boundary within `reach` pixels; or -1. */
  pick([x, y], reach) {
    const [px, py] = this.view.toPlane(x, y);
    const { pixels } = this.view;
    return halfedgeAt(this.meshState.replica, this.meshState.grid, px, py, reach / pixels, PICKED / pixels);
  }

  /** A half-edge that starts at the vertex within `reach` pixels of [x, y]; or -1. */
  pickVertex([x, y], reach) {
    const [px, py] = this.view.toPlane(x, y);
    return vertexAt(this.meshState.replica, this.meshState.grid, px, py, reach / this.view.pixels);
  }
}
