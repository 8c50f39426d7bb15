// The browser's copy of the mesh: flat arrays, set by a state message and updated by patches.
//
// Element e owns the half-edges k*e .. k*e+k-1, counter-clockwise. origin -1: the slot is dead.
// Coordinates are in the normalised frame of the state message, y up.

export const FLAG_ALIVE = 1;
const FLAG_BOUNDARY = 2;
export const FLAG_CORNER = 4;
export const FLAG_LOCKED = 8;

/** A typed array over a copy of a message's buffer (buffers may begin at odd addresses). */
export function arrayOf(Type, view) {
  const start = view.byteOffset;
  return new Type(view.buffer.slice(start, start + view.byteLength));
}

/** `array`, or a longer copy if it is shorter than `length`. */
export function withRoom(array, length) {
  if (length <= array.length) return array;
  const longer = new array.constructor(Math.max(length, Math.ceil(1.5 * array.length)));
  longer.set(array);
  return longer;
}

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
    this.head = content.head;
    this.revision = content.revision;
  }

  /** The ids that a patch changes: {vertices, halfedges}, as typed arrays. */
  idsOf(buffers) {
    return { vertices: arrayOf(Int32Array, buffers[0]), halfedges: arrayOf(Int32Array, buffers[4]) };
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
    this.head = content.head;
    this.revision = content.to;
    return true;
  }

  /** The inverse {content, buffers} of a patch; to be called before the patch is applied. */
  inverse(content, buffers) {
    const ids = this.idsOf(buffers);
    const vertices = ids.vertices.filter((v) => v < this.vertices);
    const halfedges = ids.halfedges.filter((h) => h < this.halfedges);
    const places = new Float32Array(2 * vertices.length);
    vertices.forEach((v, i) => places.set(this.places.subarray(2 * v, 2 * v + 2), 2 * i));
    const back = [
      vertices, places, Int8Array.from(vertices, (v) => this.delta[v]),
      Uint8Array.from(vertices, (v) => this.flags[v]), halfedges,
      Int32Array.from(halfedges, (h) => this.origin[h]),
      Int32Array.from(halfedges, (h) => this.twin[h]),
    ];
    return {
      content: {
        type: "patch", from: content.to, to: content.from, vertices: this.vertices,
        halfedges: this.halfedges, head: this.head,
      },
      buffers: back.map((array) => new DataView(array.buffer)),
    };
  }

  _resize(vertices, halfedges) {
    this.places = withRoom(this.places, 2 * vertices);
    this.delta = withRoom(this.delta, vertices);
    this.flags = withRoom(this.flags, vertices);
    this.origin = withRoom(this.origin, halfedges);
    this.twin = withRoom(this.twin, halfedges);
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

  /** [x, y] of a vertex. */
  place(v) {
    return [this.places[2 * v], this.places[2 * v + 1]];
  }

  /** [[x, y], ...] the corners of element e. */
  corners(e) {
    const corners = [];
    for (let h = this.k * e; h < this.k * e + this.k; h += 1) corners.push(this.place(this.origin[h]));
    return corners;
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

  /** {left, bottom, right, top} of all live vertices; null for none. */
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
    return left > right ? null : { left, bottom, right, top };
  }
}
