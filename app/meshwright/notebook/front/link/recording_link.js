// The link to a recording in the page: answers the requests of a read-only view without Python.
//
// The recording holds the first state and one patch for each step. Inverse patches are computed while
// going forward. A jump over several steps is sent as one patch.

import { MeshReplica } from "../mesh/mesh_replica.js";
import { viewName } from "./kernel_link.js";

/** Kinds of ids in a patch. */
const CHANGED = ["vertices", "halfedges", "seats", "elements"];

export class RecordingLink {
  constructor(recording) {
    this.readOnly = true;
    this.view = viewName();
    this.onmessage = () => {};
    this._recording = recording;
    this._last = 0;
    this._open = true;
    this._state = 0;
    this._back = [];
    this._replica = new MeshReplica();
    const heads = [recording.state, ...recording.steps].map((message) => message.content.head);
    this._heads = [];
    for (const head of heads) this._heads.push({ ...this._heads[this._heads.length - 1], ...head });
    const first = recordedMessage(recording.state);
    this._replica.loadState(first.content, first.buffers);
    this._travel(recording.start);
  }

  /** Send a request; answers carry its id as `reply` and arrive asynchronously. */
  send(word, fields = {}) {
    this._last += 1;
    const id = this._last;
    queueMicrotask(() => {
      if (this._open) this._answer(word, fields, id);
    });
    return id;
  }

  close() {
    this._open = false;
  }

  _answer(word, fields, id) {
    if (word === "hello") this._deliver(this._whole(), id);
    else if (word === "go_to") this._go(fields.cursor, id);
    else if (word === "undo") this._go(this._state - 1, id);
    else if (word === "redo") this._go(this._state + 1, id);
    else if (word === "hover") this._deliver(emptyGhost(), id);
    else {
      const sentence = "This is a recording: it cannot be edited.";
      this._deliver({ content: { type: "notice", tone: "refused", sentence }, buffers: [] }, id);
    }
  }

  _deliver(message, id) {
    this.onmessage({ ...message.content, to: this._addressed(message), reply: id }, message.buffers);
  }

  /** The "to" of a patch is a revision, that of other messages the view. */
  _addressed(message) {
    return message.content.type === "patch" ? message.content.to : this.view;
  }

  _go(wanted, id) {
    const state = Math.min(Math.max(wanted, 0), this._recording.steps.length);
    if (state === this._state) return;
    const from = this._replica.revision;
    const changed = this._travel(state);
    this._deliver(changed === null ? this._whole() : this._patch(from, changed), id);
  }

  /** Go to a state; returns the changed ids as sets by kind, null for all. */
  _travel(state) {
    const changed = Object.fromEntries(CHANGED.map((name) => [name, new Set()]));
    let whole = false;
    while (this._state !== state) {
      const message = this._state < state ? this._forward() : this._backward();
      if (message.content.type === "state") {
        whole = true;
        continue;
      }
      const ids = this._replica.idsOf(message.buffers);
      for (const name of CHANGED) ids[name].forEach((id) => changed[name].add(id));
    }
    return whole ? null : changed;
  }

  _forward() {
    const replica = this._replica;
    const message = recordedMessage(this._recording.steps[this._state]);
    if (message.content.type === "state") {
      this._back[this._state] = this._whole();
      replica.loadState(message.content, message.buffers);
    } else {
      this._back[this._state] = replica.inverse(message.content, message.buffers);
      replica.applyPatch(message.content, message.buffers);
    }
    this._state += 1;
    return message;
  }

  _backward() {
    this._state -= 1;
    const message = this._back[this._state];
    if (message.content.type === "state") this._replica.loadState(message.content, message.buffers);
    else this._replica.applyPatch(message.content, message.buffers);
    return message;
  }

  /** The present state as a message. */
  _whole() {
    const { _replica: replica, _recording: recording } = this;
    const { vertices, halfedges, frame, regions } = replica;
    const content = {
      ...recording.state.content, revision: replica.revision, vertices, halfedges, frame, regions,
      head: { ...this._heads[this._state], track: recording.track },
    };
    return { content, buffers: replica.wholeBuffers() };
  }

  /** The patch from revision `from` to the present state. */
  _patch(from, changed) {
    const replica = this._replica;
    const ids = Object.fromEntries(CHANGED.map((name) => [name, Int32Array.from(changed[name])]));
    const nothing = { from: this._heads.length, scores: [], optima: [], titles: [], by: [] };
    const content = {
      type: "patch", from, to: replica.revision, vertices: replica.vertices,
      halfedges: replica.halfedges, head: { ...this._heads[this._state], track: nothing },
    };
    return { content, buffers: replica.buffersAt(ids) };
  }
}

/** {content, buffers} of a message in a recording. */
function recordedMessage(message) {
  const text = atob(message.arrays);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i += 1) bytes[i] = text.charCodeAt(i);
  const buffers = [];
  let at = 0;
  for (const size of message.sizes) {
    buffers.push(new DataView(bytes.buffer, at, size));
    at += size;
  }
  return { content: message.content, buffers };
}

/** An empty preview. */
function emptyGhost() {
  const content = { type: "ghost", halfedge: -1, offers: [], operation: null, change: 0 };
  return { content, buffers: [0, 1, 2, 3, 4].map(() => new DataView(new ArrayBuffer(0))) };
}
