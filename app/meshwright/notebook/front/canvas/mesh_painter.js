// Paints the mesh on the lower canvas. Pixels are reused: panning moves them and paints the strips that
// come into view, an edit repaints the tiles it touches, and zooming a large mesh stretches the pixels
// until the zoom ends.

import { overlap } from "../mesh/boxes.js";
import { COARSE } from "../mesh/edge_curves.js";
import { curvedValues, qualityOf } from "../mesh/quality.js";
import { outlineFrom } from "../mesh/sides.js";
import { InvertedElementsPainter } from "./inverted_elements.js";
import { MARK_SLACK } from "./markers.js";

const TILE = 64;
const CHUNK = 1500;
const COSTLY = 9;
const SETTLED = 90;
const FEW_RECTANGLES = 3;
const EDGE_WIDTH = 1.1;
const BOUNDARY_WIDTH = 1.75;
const INTERFACE_WIDTH = 1.5;
const SIDE_WIDTH = 4.5;
/** Device pixels by which a painted curve may deviate. */
export const DEVIATION = 0.2;

export class MeshPainter {
  constructor(canvas, colours, marks, afterwards) {
    this.view = null; // the painted view; within half a pixel of the requested one
    this.paints = 0;
    this.measure = ""; // what elements are coloured by: "jacobian", "shape" or nothing
    this.sides = []; // [name, half-edges] of each named side
    this._canvas = canvas;
    this._pen = canvas.getContext("2d");
    this._colours = colours;
    this._markers = marks;
    this._invertedPainter = new InvertedElementsPainter(colours);
    this._afterwards = afterwards;
    this._ratio = 1;
    this._cost = 0;
    this._stale = true;
    this._boxes = [];
    this._stretched = null;
    this._timer = 0;
  }

  /** Paint this mesh from now on. */
  show(replica, derived, grid) {
    this._replica = replica;
    this._derived = derived;
    this._grid = grid;
  }

  /** The canvas has another size in device pixels. */
  resize(width, height, ratio) {
    this._canvas.width = width;
    this._canvas.height = height;
    this._ratio = ratio;
    this.forget();
  }

  /** Repaint everything next time. */
  forget() {
    this._stale = true;
    this._invertedPainter.forget();
  }

  /** These boxes {left, bottom, right, top} of the plane have changed. */
  touch(boxes) {
    this._boxes.push(...boxes);
  }

  /** Paint `view`, reusing pixels where possible. */
  paint(view) {
    if (!this._replica || !this._canvas.width) return;
    const shown = this.view;
    if (this._stale || !shown) this._paintAll(view);
    else if (shown.pixels !== view.pixels || this._stretched) this._zoom(view);
    else {
      this._scroll(view);
      this._repaint();
    }
    this._boxes = [];
    this.paints += 1;
  }

  release() {
    clearTimeout(this._timer);
  }

  // Whole canvas, or parts

  _paintAll(view) {
    clearTimeout(this._timer);
    const began = performance.now();
    this.view = view;
    this._stale = false;
    this._stretched = null;
    this._edgeWidth = Math.min(EDGE_WIDTH, Math.max(0.12 * this._derived.typical * view.pixels, 0.34));
    this._paintRegion([[0, 0, this._canvas.width, this._canvas.height]]);
    this._cost = performance.now() - began;
  }

  /** Move the pixels, and paint the strips that come into view. */
  _scroll(view) {
    const { width, height } = this._canvas;
    const [ratio, shown] = [this._ratio, this.view];
    const dx = Math.round((shown.x - view.x) * view.pixels * ratio);
    const dy = Math.round((view.y - shown.y) * view.pixels * ratio);
    if (!dx && !dy) return;
    if (Math.abs(dx) > 0.7 * width || Math.abs(dy) > 0.7 * height) {
      this._paintAll(view);
      return;
    }
    const pen = this._pen;
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.globalCompositeOperation = "copy";
    pen.drawImage(this._canvas, dx, dy);
    pen.globalCompositeOperation = "source-over";
    this.view = shown.panned(dx / ratio, dy / ratio);
    const strips = [];
    const [across, down] = [Math.abs(dx), Math.abs(dy)];
    if (dy) strips.push([0, dy > 0 ? 0 : height - down, width, down]);
    if (dx) strips.push([dx > 0 ? 0 : width - across, dy > 0 ? down : 0, across, height - down]);
    this._paintRegion(strips);
  }

  /** Stretch the painted pixels, and repaint once the zoom ends. */
  _zoom(view) {
    if (this._cost < COSTLY) {
      this._paintAll(view);
      return;
    }
    if (!this._stretched) {
      const copy = document.createElement("canvas");
      copy.width = this._canvas.width;
      copy.height = this._canvas.height;
      copy.getContext("2d").drawImage(this._canvas, 0, 0);
      this._stretched = { copy, view: this.view };
    }
    this.view = view;
    const { copy, view: old } = this._stretched;
    const pen = this._pen;
    this._ground(pen);
    const scale = view.pixels / old.pixels;
    const [x, y] = view.toScreen(...old.toPlane(0, 0));
    pen.drawImage(copy, x, y, old.width * scale, old.height * scale);
    clearTimeout(this._timer);
    this._timer = setTimeout(() => {
      this._paintAll(this.view);
      this._afterwards();
    }, SETTLED);
  }

  /** Paint the tiles that the touched boxes reach. */
  _repaint() {
    if (!this._boxes.length) return;
    const [ratio, view] = [this._ratio, this.view];
    const tile = TILE * Math.ceil(ratio);
    const columns = Math.ceil(this._canvas.width / tile);
    const rows = Math.ceil(this._canvas.height / tile);
    const dirty = new Uint8Array(columns * rows);
    let count = 0;
    for (const box of this._boxes) {
      const [left, top] = view.toScreen(box.left, box.top);
      const [right, bottom] = view.toScreen(box.right, box.bottom);
      const column = (x) => Math.floor((x * ratio) / tile);
      const first = Math.max(column(left - MARK_SLACK), 0);
      const last = Math.min(column(right + MARK_SLACK), columns - 1);
      const low = Math.min(column(bottom + MARK_SLACK), rows - 1);
      for (let j = Math.max(column(top - MARK_SLACK), 0); j <= low; j += 1) {
        for (let i = first; i <= last; i += 1) {
          if (!dirty[j * columns + i]) count += 1;
          dirty[j * columns + i] = 1;
        }
      }
    }
    if (count > 0.6 * columns * rows) this._paintAll(view);
    else if (count) this._paintRegion(tileRuns(dirty, columns, rows, tile));
  }

  /** Paint rectangles [x, y, width, height] of device pixels. A few are painted one by one: clipping
   * to one rectangle is free.
   */
  _paintRegion(rectangles) {
    if (rectangles.length > FEW_RECTANGLES) this._paintClipped(rectangles);
    else for (const rectangle of rectangles) this._paintClipped([rectangle]);
  }

  _paintClipped(rectangles) {
    const [pen, ratio, view] = [this._pen, this._ratio, this.view];
    pen.save();
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.beginPath();
    for (const rectangle of rectangles) pen.rect(...rectangle);
    pen.clip();
    this._ground(pen);
    const elements = this._elementsIn(rectangles.map((r) => r.map((value) => value / ratio)));
    if (this.measure) this._paintQuality(pen, elements);
    this._paintEdges(pen, elements);
    const { inverted, interfaces, loops } = this._derived;
    this._invertedPainter.paint(pen, ratio, view, this._replica, inverted, this._tolerance);
    pen.strokeStyle = this._colours.boundary;
    if (interfaces.length) {
      pen.lineWidth = Math.max(INTERFACE_WIDTH, 1.2 * this._edgeWidth);
      this._path(pen, interfaces.map((h) => [h]), false);
      pen.stroke();
    }
    pen.lineWidth = Math.max(BOUNDARY_WIDTH, 1.3 * this._edgeWidth);
    this._path(pen, loops);
    pen.stroke();
    this._paintSides(pen);
    this._markers.paint(pen, ratio, view, this._replica, this._derived, boxesOf(rectangles, ratio));
    pen.restore();
  }

  _ground(pen) {
    const { width, height } = this._canvas;
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.fillStyle = this._colours.background;
    pen.fillRect(0, 0, width, height);
    pen.setTransform(this._ratio, 0, 0, this._ratio, 0, 0);
    pen.lineJoin = "round";
    pen.lineCap = "round";
    pen.fillStyle = this._colours.fill;
    this._path(pen, this._derived.loops);
    pen.fill("evenodd");
    this._derived.regionLoops.forEach((loops, region) => {
      pen.fillStyle = this._colours.ofRegion(region);
      this._path(pen, loops);
      pen.fill("evenodd");
    });
  }

  /** Greatest deviation of painted curves, in the plane. */
  get _tolerance() {
    return DEVIATION / (this.view.pixels * this._ratio);
  }

  /** Begin a path of chains of half-edges, closed ones by default. What is out of view is coarse. */
  _path(pen, chains, closed = true) {
    const replica = this._replica;
    const { origin, places, edgeCurves } = replica;
    const { pixels, width, height, x, y } = this.view;
    const [shiftX, shiftY] = [width / 2 - x * pixels, height / 2 + y * pixels];
    const window = this.view.box(4);
    const fine = Math.min(this._tolerance, COARSE);
    pen.beginPath();
    for (const chain of chains) {
      const first = 2 * origin[chain[0]];
      pen.moveTo(places[first] * pixels + shiftX, shiftY - places[first + 1] * pixels);
      for (const h of chain) {
        const edge = edgeCurves.get(h);
        if (!edge) {
          const end = 2 * replica.target(h);
          pen.lineTo(places[end] * pixels + shiftX, shiftY - places[end + 1] * pixels);
          continue;
        }
        const path = edge.path(overlap(edge.box, window) ? fine : COARSE);
        for (let i = 2; i < path.length; i += 2) {
          pen.lineTo(path[i] * pixels + shiftX, shiftY - path[i + 1] * pixels);
        }
      }
      if (closed) pen.closePath();
    }
  }

  _elementsIn(rectangles) {
    const found = rectangles.map(([x, y, width, height]) => {
      const [left, top] = this.view.toPlane(x - 2, y - 2);
      const [right, bottom] = this.view.toPlane(x + width + 2, y + height + 2);
      return this._grid.near(left, bottom, right, top);
    });
    return found.length === 1 ? found[0] : new Set(found.flat());
  }

  /** Fill these elements by their quality. */
  _paintQuality(pen, elements) {
    const curved = curvedValues(this._replica.head);
    const scale = this._colours.qualityScale();
    for (const e of elements) {
      if (!this._replica.live(this._replica.k * e)) continue;
      const colour = this._colours.ofQuality(qualityOf(this._replica, e, this.measure, curved), scale);
      pen.fillStyle = colour;
      pen.strokeStyle = colour;
      pen.lineWidth = 0.6; // neighbours of one colour show no gap
      pen.beginPath();
      for (const [x, y] of outlineFrom(this._replica, this._replica.k * e, this._tolerance)) {
        pen.lineTo(...this.view.toScreen(x, y));
      }
      pen.closePath();
      pen.fill();
      pen.stroke();
    }
  }

  /** Named sides, each in the colour of its name. */
  _paintSides(pen) {
    pen.lineWidth = SIDE_WIDTH;
    this.sides.forEach(([, halfedges], number) => {
      pen.strokeStyle = this._colours.ofName(number);
      this._path(pen, halfedges.map((h) => [h]), false);
      pen.stroke();
    });
  }

  /** Every inner edge of these elements once; all are straight but interfaces, painted later. */
  _paintEdges(pen, elements) {
    const { k, origin, twin, places, regions, region } = this._replica;
    const { pixels, width, height, x, y } = this.view;
    const [shiftX, shiftY] = [width / 2 - x * pixels, height / 2 + y * pixels];
    const several = regions.length > 1;
    pen.strokeStyle = this._colours.edge;
    pen.lineWidth = this._edgeWidth;
    pen.beginPath();
    let count = 0;
    for (const e of elements) {
      for (let h = k * e, last = h + k - 1; h <= last; h += 1) {
        if (twin[h] < h) continue; // the boundary, and edges painted from the other side
        if (several && region[e] !== region[Math.floor(twin[h] / k)]) continue; // an interface
        const a = 2 * origin[h];
        const b = 2 * origin[h === last ? k * e : h + 1];
        pen.moveTo(places[a] * pixels + shiftX, shiftY - places[a + 1] * pixels);
        pen.lineTo(places[b] * pixels + shiftX, shiftY - places[b + 1] * pixels);
        count += 1;
      }
      if (count >= CHUNK) {
        pen.stroke();
        pen.beginPath();
        count = 0;
      }
    }
    pen.stroke();
  }
}

/** Dirty tiles as rectangles: neighbours in a row are one, and so are equal runs of rows. */
function tileRuns(dirty, columns, rows, tile) {
  const runs = [];
  let above = new Map();
  for (let j = 0; j < rows; j += 1) {
    const here = new Map();
    for (let i = 0; i < columns; i += 1) {
      if (!dirty[j * columns + i]) continue;
      const start = i;
      while (i + 1 < columns && dirty[j * columns + i + 1]) i += 1;
      const key = `${start} ${i}`;
      const run = above.get(key) || [start * tile, j * tile, (i + 1 - start) * tile, 0];
      if (!run[3]) runs.push(run);
      run[3] += tile;
      here.set(key, run);
    }
    above = here;
  }
  return runs;
}

/** Rectangles [x, y, width, height] of device pixels as boxes of pixels. */
function boxesOf(rectangles, ratio) {
  return rectangles.map(([x, y, width, height]) => ({
    left: x / ratio, top: y / ratio, right: (x + width) / ratio, bottom: (y + height) / ratio,
  }));
}
