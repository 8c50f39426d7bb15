// The browser's copy of the mesh: flat arrays, set by a state message and updated by patches.
//
// Element e owns the half-edges k*e .. k*e+k-1, counter-clockwise. origin -1: the slot is dead.
// Coordinates are in the normalised frame of the state message, y up. Vertices on the boundary or on
// an interface of regions know their curve and their parameter on it.

import { enlarge } from "./boxes.js";
import { CURVE_BUFFERS, Curves } from "./curves.js";
import { EdgeCurves } from "./edge_curves.js";
import { arrayOf, withRoom } from "./typed_arrays.js";

export const FLAG_ALIVE = 1;
const FLAG_BOUNDARY = 2;
export const FLAG_CORNER = 4;
export const FLAG_LOCKED = 8;
/** With FLAG_CORNER: a geometric vertex on a straight side. */
export const FLAG_ANCHOR = 16;
export const FLAG_PINNED = 32;

/** Buffers of a state message: five of vertices and half-edges, vertices on curves with curve and
 * parameter, regions of elements (empty: all are of one), then the curves.
 */
const SEATS = 5;
const REGIONS = 8;
const CURVES = 9;

export class MeshReplica {
  constructor() {
    this.revision = -1;
    this.k = 4;
    this.vertices = 0;
    this.halfedges = 0;
    this.frame = { cx: 0, cy: 0, scale: 1 };
    this.head = null;
    this.catalogue = [];
    this.readOnly = false;
    this.places = new Float32Array(0);
    this.delta = new Int8Array(0);
    this.flags = new Uint8Array(0);
    this.origin = new Int32Array(0);
    this.twin = new Int32Array(0);
    this.curve = new Int32Array(0);
    this.parameter = new Float64Array(0);
    this.region = new Int16Array(0);
    this.regions = [""];
    this.curves = new Curves();
    this.edgeCurves = new EdgeCurves();
  }

  /** Load a whole state. */
  loadState(content, buffers) {
    this.k = content.k;
    this.vertices = content.vertices;
    this.halfedges = content.halfedges;
    this.frame = content.frame;
    this.catalogue = content.catalogue;
    this.readOnly = content.read_only === true;
    this.places = arrayOf(Float32Array, buffers[0]);
    this.delta = arrayOf(Int8Array, buffers[1]);
    this.flags = arrayOf(Uint8Array, buffers[2]);
    this.origin = arrayOf(Int32Array, buffers[3]);
    this.twin = arrayOf(Int32Array, buffers[4]);
    this.curve = new Int32Array(this.vertices).fill(-1);
    this.parameter = new Float64Array(this.vertices);
    this._seat(buffers, SEATS);
    this.regions = content.regions;
    this.region = buffers[REGIONS].byteLength
      ? arrayOf(Int16Array, buffers[REGIONS]) : new Int16Array(this.elements);
    this.curves = new Curves(buffers.slice(CURVES, CURVES + CURVE_BUFFERS));
    this.head = content.head;
    this.revision = content.revision;
  }

  /** Set curves and parameters: buffers of ids, curves and parameters from `at` on. */
  _seat(buffers, at) {
    const curve = arrayOf(Int32Array, buffers[at + 1]);
    const parameter = arrayOf(Float64Array, buffers[at + 2]);
    arrayOf(Int32Array, buffers[at]).forEach((v, i) => {
      this.curve[v] = curve[i];
      this.parameter[v] = parameter[i];
    });
  }

  /** The ids that a patch changes: {vertices, halfedges, seats, elements}, as typed arrays: seats
   * are vertices whose place on a curve changes, elements those whose region does.
   */
  idsOf(buffers) {
    const [vertices, halfedges, seats, elements] = [0, 4, 7, 10].map((i) => arrayOf(Int32Array, buffers[i]));
    return { vertices, halfedges, seats, elements };
  }

  /** Apply a patch; returns false, unchanged, if it is not for this revision. */
  applyPatch(content, buffers) {
    if (content.from !== this.revision) return false;
    const ids = this.idsOf(buffers);
    const places = arrayOf(Float32Array, buffers[1]);
    const delta = arrayOf(Int8Array, buffers[2]);
    const flags = arrayOf(Uint8Array, buffers[3]);
    const origin = arrayOf(Int32Array, buffers[5]);
    const twin = arrayOf(Int32Array, buffers[6]);
    this._resize(content.vertices, content.halfedges);
    ids.vertices.forEach((v, i) => {
      this.places[2 * v] = places[2 * i];
      this.places[2 * v + 1] = places[2 * i + 1];
      this.delta[v] = delta[i];
      this.flags[v] = flags[i];
    });
    ids.halfedges.forEach((h, i) => {
      this.origin[h] = origin[i];
      this.twin[h] = twin[i];
    });
    this._seat(buffers, 7);
    const region = arrayOf(Int16Array, buffers[11]);
    ids.elements.forEach((e, i) => (this.region[e] = region[i]));
    this.head = content.head;
    this.revision = content.to;
    return true;
  }

  /** The inverse {content, buffers} of a patch; to be called before the patch is applied. */
  inverse(content, buffers) {
    return {
      content: {
        type: "patch", from: content.to, to: content.from, vertices: this.vertices,
        halfedges: this.halfedges, head: this.head,
      },
      buffers: this.buffersAt(this.idsOf(buffers)),
    };
  }

  /** The buffers of a patch that sets the present values at these ids, {vertices, halfedges, seats,
   * elements} in typed arrays; those beyond the ends are left out.
   */
  buffersAt(ids) {
    const [vertices, seats] = [ids.vertices, ids.seats].map((some) => some.filter((v) => v < this.vertices));
    const halfedges = ids.halfedges.filter((h) => h < this.halfedges);
    const elements = ids.elements.filter((e) => e < this.elements);
    const places = new Float32Array(2 * vertices.length);
    vertices.forEach((v, i) => places.set(this.places.subarray(2 * v, 2 * v + 2), 2 * i));
    return [
      vertices, places, Int8Array.from(vertices, (v) => this.delta[v]),
      Uint8Array.from(vertices, (v) => this.flags[v]), halfedges,
      Int32Array.from(halfedges, (h) => this.origin[h]),
      Int32Array.from(halfedges, (h) => this.twin[h]),
      seats, Int32Array.from(seats, (v) => this.curve[v]),
      Float64Array.from(seats, (v) => this.parameter[v]),
      elements, Int16Array.from(elements, (e) => this.region[e]),
    ].map((array) => new DataView(array.buffer));
  }

  /** The buffers of a state with everything as it is now. */
  wholeBuffers() {
    const { vertices, halfedges } = this;
    const seats = Int32Array.from(this.curve.subarray(0, vertices).keys()).filter((v) => this.curve[v] >= 0);
    const arrays = [
      this.places.slice(0, 2 * vertices), this.delta.slice(0, vertices), this.flags.slice(0, vertices),
      this.origin.slice(0, halfedges), this.twin.slice(0, halfedges),
      seats, Int32Array.from(seats, (v) => this.curve[v]),
      Float64Array.from(seats, (v) => this.parameter[v]),
      this.region.slice(0, this.regions.length > 1 ? this.elements : 0),
    ];
    return [...arrays.map((array) => new DataView(array.buffer)), ...this.curves.buffers];
  }

  _resize(vertices, halfedges) {
    this.places = withRoom(this.places, 2 * vertices);
    this.delta = withRoom(this.delta, vertices);
    this.flags = withRoom(this.flags, vertices);
    this.origin = withRoom(this.origin, halfedges);
    this.twin = withRoom(this.twin, halfedges);
    this.curve = withRoom(this.curve, vertices);
    this.parameter = withRoom(this.parameter, vertices);
    this.region = withRoom(this.region, halfedges / this.k);
    this.curve.fill(-1, Math.min(this.vertices, vertices));
    this.region.fill(0, Math.min(this.halfedges, halfedges) / this.k);
    this.origin.fill(-1, halfedges);
    this.twin.fill(-1, halfedges);
    this.flags.fill(0, vertices);
    this.vertices = vertices;
    this.halfedges = halfedges;
  }

  // Navigation

  get elements() {
    return this.halfedges / this.k;
  }

  live(h) {
    return h >= 0 && h < this.halfedges && this.origin[h] >= 0;
  }

  element(h) {
    return Math.floor(h / this.k);
  }

  next(h) {
    return h % this.k === this.k - 1 ? h - this.k + 1 : h + 1;
  }

  prev(h) {
    return h % this.k === 0 ? h + this.k - 1 : h - 1;
  }

  target(h) {
    return this.origin[this.next(h)];
  }

  /** Whether the edge of h lies between two regions. */
  constrained(h) {
    const { twin, region, k } = this;
    return twin[h] >= 0 && region[Math.floor(h / k)] !== region[Math.floor(twin[h] / k)];
  }

  /** [x, y] of a vertex. */
  place(v) {
    return [this.places[2 * v], this.places[2 * v + 1]];
  }

  /** The half-edges with the origin of h, h first; traversals are capped. */
  around(h) {
    const found = [h];
    let at = this.twin[this.prev(h)];
    while (at >= 0 && at !== h && found.length <= this.halfedges) {
      found.push(at);
      at = this.twin[this.prev(at)];
    }
    if (at === h) return found;
    at = this.twin[h];
    while (at >= 0 && found.length <= this.halfedges) {
      at = this.next(at);
      found.push(at);
      at = this.twin[at];
    }
    return found;
  }

  /** The degree of the origin of h. */
  degree(h) {
    const boundary = this.flags[this.origin[h]] & FLAG_BOUNDARY;
    return this.around(h).length + (boundary ? 1 : 0);
  }

  /** {left, bottom, right, top} of the mesh; null if it is empty. */
  bounds() {
    let left = Infinity;
    let bottom = Infinity;
    let right = -Infinity;
    let top = -Infinity;
    for (let v = 0; v < this.vertices; v += 1) {
      if (!(this.flags[v] & FLAG_ALIVE)) continue;
      const x = this.places[2 * v];
      const y = this.places[2 * v + 1];
      if (x < left) left = x;
      if (x > right) right = x;
      if (y < bottom) bottom = y;
      if (y > top) top = y;
    }
    if (left > right) return null;
    const box = { left, bottom, right, top };
    for (const edge of this.edgeCurves.all()) enlarge(box, edge.box);
    return box;
  }
}
