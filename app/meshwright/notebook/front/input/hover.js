// The half-edge under the pointer, the operations there, and the one that is previewed.
//
// The arrow follows the pointer at once; verdicts ("offers") and preview ("ghost") come from Python.
// One request is pending at a time; half-edges passed in the meantime are skipped.

import { ghostOf } from "../canvas/ghost.js";
import { asSentence } from "../dom.js";
import { halfedgeNear } from "../mesh/picking.js";
import { middleOfElement } from "../mesh/sides.js";

const ANSWER_TIMEOUT = 3000;
const ANTICIPATE = { after: 14, times: 3 };

export class HoverState {
  constructor(card) {
    this.halfedge = -1;
    this.pinned = false; // set by keyboard, menu or hint, and not by the mouse
    this.armed = null; // the operation that a click applies
    this.offers = null; // operation -> {allowed, reason, change} at the half-edge
    this.ghost = null;
    this._card = card;
    this._picked = null; // chosen for this half-edge by the keyboard
    this._previewed = null; // of the focused row of a menu
    this._pending = null; // the pending request: {id, halfedge, operation, at}
    this._answered = ""; // the key of the request that offers and ghost answer
    this._applyWhenKnown = false;
    this._offersKey = "";
    this._place = null; // centre of its element
  }

  /** Point at a half-edge, -1 for none. */
  point(halfedge, pinned = false) {
    this.pinned = pinned && halfedge >= 0;
    if (halfedge === this.halfedge) return;
    this.halfedge = halfedge;
    this._place = halfedge < 0 ? null : middleOfElement(this._card.replica, this._card.replica.element(halfedge));
    this._picked = this._previewed = null;
    this._applyWhenKnown = false;
    this._forget();
    this._card.pointed();
  }

  /** The chosen operation; null: the best one, chosen by Python. */
  get wanted() {
    return this._previewed || this._picked || this.armed;
  }

  /** The previewed operation, or null. */
  get previewed() {
    return this.ghost ? this.ghost.operation : null;
  }

  /** Arm an operation, which clicks apply from then on; the armed one: disarm it. */
  arm(operation) {
    this.armed = operation === this.armed ? null : operation;
    this._picked = null;
    this._reset();
  }

  /** Preview the operation of a menu's row; null: end that. */
  preview(operation) {
    if (operation === this._previewed) return;
    this._previewed = operation;
    this._reset();
  }

  /** Choose the next allowed operation (1), or the previous one (-1). */
  cycle(step) {
    if (!this.offers) return;
    const allowed = [...this.offers.keys()].filter((name) => this.offers.get(name).allowed);
    if (!allowed.length) return;
    const at = allowed.indexOf(this.previewed);
    const next = allowed[at < 0 ? (step > 0 ? 0 : allowed.length - 1)
      : (at + step + allowed.length) % allowed.length];
    if (this.armed) this.armed = next;
    else this._picked = next;
    this._reset();
  }

  /** Apply the previewed operation; if the preview is pending, as soon as it arrives. */
  act() {
    if (this.halfedge < 0) this._card.notify("refused", "Point at a half-edge first.");
    else if (this.ghost) this._card.operate(this.ghost.operation, this.halfedge);
    else if (this.offers) this._card.notify("refused", this._refusal());
    else this._applyWhenKnown = true;
  }

  /** Discard what is known, after a change of the mesh or of the agent's state. */
  renew() {
    const { replica } = this._card;
    if (this.halfedge >= 0 && !replica.live(this.halfedge)) {
      // keyboard navigation continues at the same place
      this.halfedge = this.pinned && this._place ? halfedgeNear(replica, ...this._place) : -1;
    }
    this._forget();
    this._card.pointed();
  }

  /** Handle a preview message. */
  receive(content, buffers) {
    const pending = this._pending;
    if (!pending || content.reply !== pending.id) return;
    this._pending = null;
    if (content.halfedge === this.halfedge && content.halfedge >= 0) {
      this._answered = this._key();
      this._offer(content.offers);
      const of = pending.operation === this.wanted;
      this.ghost = of ? ghostOf(content, buffers) : null;
      if (!of) this._answered = "";
      this._card.pointed();
      if (of && this._applyWhenKnown) {
        this._applyWhenKnown = false;
        this.act();
      }
    }
    this.request();
  }

  /** Handle the refusal of the request of this id; returns whether it was one for a preview: then
   * the mesh has changed in the meantime, and no message is shown.
   */
  refused(id) {
    if (!this._pending || this._pending.id !== id) return false;
    this._pending = null;
    return true;
  }

  /** Request offers and preview, unless they are known or pending. */
  request() {
    const card = this._card;
    if (card.readOnly || card.agentBusy || this.halfedge < 0) return;
    if (this._key() === this._answered) return;
    const now = performance.now();
    if (this._pending && now - this._pending.at < ANSWER_TIMEOUT) return;
    const fields = {
      halfedge: this.halfedge, operation: this.wanted, tolerance: Math.min(card.stage.tolerance, 1),
    };
    this._pending = { id: card.link.send("hover", fields), at: now, ...fields };
  }

  /** Request the preview of the state after the pending operation, while `waiting()`.
   *
   * This saves a round trip. And Jupyter's server delays a small message until the browser has
   * acknowledged the previous one (Nagle's algorithm), which takes 40 ms unless the browser sends.
   */
  anticipate(waiting, times = ANTICIPATE.times) {
    if (times === 0) return;
    setTimeout(() => {
      if (!waiting()) return;
      this._pending = null;
      this._answered = "";
      this.request();
      this.anticipate(waiting, times - 1);
    }, ANTICIPATE.after);
  }

  /** Keep the offers; equal ones stay the same object, so that an open menu is not rebuilt. */
  _offer(offers) {
    const key = JSON.stringify(offers);
    if (this.offers && key === this._offersKey) return;
    this._offersKey = key;
    this.offers = new Map(offers.map((offer) => [offer.operation, offer]));
  }

  _key() {
    return `${this._card.replica.revision} ${this.halfedge} ${this.wanted}`;
  }

  _reset() {
    this.ghost = null;
    this._answered = "";
    this._card.pointed();
  }

  _forget() {
    this.offers = this.ghost = null;
    this._answered = "";
  }

  _refusal() {
    const offer = this.offers.get(this.wanted);
    return offer && offer.reason ? asSentence(offer.reason) : "No operation is allowed here.";
  }
}
