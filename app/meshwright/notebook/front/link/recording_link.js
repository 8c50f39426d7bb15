// The link to a film that lies in the page: it answers as Python would, of what can be watched.
//
// The recording holds the first state and one message for each step. The steps back are made here,
// on the way forward. A jump over many steps is one message of all that they change.

import { Mirror } from "../mesh/mesh_replica.js";
import { viewName } from "./kernel_link.js";

export class FilmLink {
  constructor(film) {
    this.readOnly = true;
    this.view = viewName();
    this.onmessage = () => {};
    this._film = film;
    this._last = 0;
    this._open = true;
    this._state = 0;
    this._back = [];
    this._mirror = new Mirror();
    const heads = [film.state, ...film.steps].map((message) => message.content.head);
    this._heads = [];
    for (const head of heads) this._heads.push({ ...this._heads[this._heads.length - 1], ...head });
    const first = filmMessage(film.state);
    this._mirror.loadState(first.content, first.buffers);
    this._travel(film.start);
  }

  /** Say something to the film; answers carry the id as `reply`, and come later. */
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
    if (word === "hello") this._say(this._whole(), id);
    else if (word === "go_to") this._go(fields.cursor, id);
    else if (word === "undo") this._go(this._state - 1, id);
    else if (word === "redo") this._go(this._state + 1, id);
    else if (word === "hover") this._say(filmNoGhost(), id);
    else {
      const sentence = "This is a frozen film: it can be watched, not changed.";
      this._say({ content: { say: "notice", tone: "refused", sentence }, buffers: [] }, id);
    }
  }

  _say(message, id) {
    this.onmessage({ ...message.content, to: this._addressed(message), reply: id }, message.buffers);
  }

  /** A patch's "to" is a revision; of all else it is the view. */
  _addressed(message) {
    return message.content.say === "patch" ? message.content.to : this.view;
  }

  _go(wanted, id) {
    const state = Math.min(Math.max(wanted, 0), this._film.steps.length);
    if (state === this._state) return;
    const from = this._mirror.revision;
    const changed = this._travel(state);
    this._say(changed === null ? this._whole() : this._patch(from, changed), id);
  }

  /** Go to a state; returns what that changes, {vertices, halfedges} as sets, null for everything. */
  _travel(state) {
    const changed = { vertices: new Set(), halfedges: new Set() };
    let whole = false;
    while (this._state !== state) {
      const message = this._state < state ? this._forward() : this._backward();
      if (message.content.say === "state") {
        whole = true;
        continue;
      }
      const ids = this._mirror.idsOf(message.buffers);
      ids.vertices.forEach((v) => changed.vertices.add(v));
      ids.halfedges.forEach((h) => changed.halfedges.add(h));
    }
    return whole ? null : changed;
  }

  _forward() {
    const mirror = this._mirror;
    const message = filmMessage(this._film.steps[this._state]);
    if (message.content.say === "state") {
      this._back[this._state] = this._whole();
      mirror.loadState(message.content, message.buffers);
    } else {
      this._back[this._state] = mirror.inverse(message.content, message.buffers);
      mirror.applyPatch(message.content, message.buffers);
    }
    this._state += 1;
    return message;
  }

  _backward() {
    this._state -= 1;
    const message = this._back[this._state];
    if (message.content.say === "state") this._mirror.loadState(message.content, message.buffers);
    else this._mirror.applyPatch(message.content, message.buffers);
    return message;
  }

  /** The present state as a message. */
  _whole() {
    const { _mirror: mirror, _film: film } = this;
    const { vertices, halfedges } = mirror;
    const arrays = [
      mirror.places.slice(0, 2 * vertices), mirror.delta.slice(0, vertices),
      mirror.flags.slice(0, vertices), mirror.origin.slice(0, halfedges),
      mirror.twin.slice(0, halfedges),
    ];
    const content = {
      ...film.state.content, revision: mirror.revision, vertices, halfedges, frame: mirror.frame,
      head: { ...this._heads[this._state], track: film.track },
    };
    return { content, buffers: arrays.map((array) => new DataView(array.buffer)) };
  }

  /** What leads a view from revision `from` here. */
  _patch(from, changed) {
    const mirror = this._mirror;
    const vertices = Int32Array.from(changed.vertices).filter((v) => v < mirror.vertices);
    const halfedges = Int32Array.from(changed.halfedges).filter((h) => h < mirror.halfedges);
    const places = new Float32Array(2 * vertices.length);
    vertices.forEach((v, i) => places.set(mirror.places.subarray(2 * v, 2 * v + 2), 2 * i));
    const arrays = [
      vertices, places, Int8Array.from(vertices, (v) => mirror.delta[v]),
      Uint8Array.from(vertices, (v) => mirror.flags[v]), halfedges,
      Int32Array.from(halfedges, (h) => mirror.origin[h]),
      Int32Array.from(halfedges, (h) => mirror.twin[h]),
    ];
    const nothing = { from: this._heads.length, scores: [], optima: [], titles: [], by: [] };
    const content = {
      say: "patch", from, to: mirror.revision, vertices: mirror.vertices,
      halfedges: mirror.halfedges, head: { ...this._heads[this._state], track: nothing },
    };
    return { content, buffers: arrays.map((array) => new DataView(array.buffer)) };
  }
}

/** {content, buffers} of a message in a recording. */
function filmMessage(message) {
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

/** The answer to "what if": in a film nothing is. */
function filmNoGhost() {
  const content = { say: "ghost", halfedge: -1, offers: [], operation: null, change: 0 };
  return { content, buffers: [0, 1, 2, 3, 4].map(() => new DataView(new ArrayBuffer(0))) };
}
