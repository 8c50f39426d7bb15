// The mesh with its derived data and spatial grid, updated together by messages.

import { DerivedData } from "./derived.js";
import { MeshReplica } from "./mesh_replica.js";
import { boxOf } from "./sides.js";
import { SpatialGrid } from "./spatial_grid.js";

const DIRTY_SHARE = 0.4;

export class MeshState {
  constructor() {
    this.replica = new MeshReplica();
    this.derived = new DerivedData(this.replica);
    this.grid = new SpatialGrid(this.replica);
  }

  /** Load a state. */
  load(content, buffers) {
    this.replica.loadState(content, buffers);
    this.replica.edgeCurves.follow(this.replica, true);
    this.derived = new DerivedData(this.replica);
    this.grid = new SpatialGrid(this.replica);
  }

  /** Apply a patch. Returns the changed boxes of the plane, null for most of it, undefined if the
   * patch is not for this revision.
   */
  patch(content, buffers) {
    const { replica } = this;
    if (content.from !== replica.revision) return undefined;
    const touched = this._touched(replica.idsOf(buffers), content);
    const many = touched.length > DIRTY_SHARE * replica.elements || replica.elements > 2 * this.grid.made;
    const boxes = many ? null : touched.map((e) => boxOf(replica, e));
    if (!many) touched.forEach((e) => this.grid.remove(e));
    replica.applyPatch(content, buffers);
    replica.edgeCurves.follow(replica);
    if (many) this.grid = new SpatialGrid(replica);
    else {
      for (const e of touched) {
        this.grid.add(e);
        boxes.push(boxOf(replica, e));
      }
    }
    this.derived = new DerivedData(replica);
    return boxes && boxes.filter((box) => box !== null);
  }

  /** Elements changed by a patch: of its half-edges, and around its vertices before the patch. */
  _touched(ids, content) {
    const { k, origin, halfedges } = this.replica;
    const changed = new Uint8Array(Math.max(content.vertices, this.replica.vertices));
    ids.vertices.forEach((v) => (changed[v] = 1));
    ids.seats.forEach((v) => (changed[v] = 1));
    const touched = new Uint8Array(Math.max(content.halfedges, halfedges) / k);
    ids.halfedges.forEach((h) => (touched[Math.floor(h / k)] = 1));
    ids.elements.forEach((e) => (touched[e] = 1));
    for (let h = 0; h < halfedges; h += 1) {
      if (origin[h] >= 0 && changed[origin[h]]) touched[Math.floor(h / k)] = 1;
    }
    const found = [];
    touched.forEach((is, e) => is && found.push(e));
    return found;
  }
}
