// What is pointed at, what operations would do there, and which one is meant.
//
// The arrow follows the pointer at once; offers and ghost come from Python. One question is under way
// at a time, and the latest wins: what was passed over meanwhile is never asked.

import { ghostOf } from "../canvas/ghost.js";
import { asSentence } from "../dom.js";
import { halfedgeNear, middleOf } from "../mesh/picking.js";

const ANSWER_TIMEOUT = 3000;
const ANTICIPATE = { after: 14, times: 3 };

export class HoverState {
  constructor(card) {
    this.halfedge = -1;
    this.pinned = false; // by the keyboard, a menu or a hint: the mouse is elsewhere
    this.armed = null; // the operation that a click does
    this.offers = null; // operation -> {allowed, reason, change}, of the half-edge pointed at
    this.ghost = null;
    this._card = card;
    this._picked = null; // chosen for this half-edge by the keyboard
    this._previewed = null; // of the row of a menu that is pointed at
    this._asked = null; // the question under way: {id, halfedge, operation, at}
    this._answered = ""; // what offers and ghost are of
    this._acting = false;
    this._offersKey = "";
    this._place = null; // where in the plane the half-edge was
  }

  /** Point at a half-edge, -1 for none. */
  point(halfedge, pinned = false) {
    this.pinned = pinned && halfedge >= 0;
    if (halfedge === this.halfedge) return;
    this.halfedge = halfedge;
    this._place = halfedge < 0 ? null : middleOf(this._card.replica.corners(this._card.replica.element(halfedge)));
    this._picked = this._previewed = null;
    this._acting = false;
    this._forget();
    this._card.pointed();
  }

  /** The operation that has been chosen, by whatever way; null: Python says which is best. */
  get wanted() {
    return this._previewed || this._picked || this.armed;
  }

  /** The operation whose ghost is shown, or null. */
  get meant() {
    return this.ghost ? this.ghost.operation : null;
  }

  /** From now on a click does this operation; the armed one again: a click opens the menu. */
  arm(operation) {
    this.armed = operation === this.armed ? null : operation;
    this._picked = null;
    this._reset();
  }

  /** Show the ghost of this operation while a menu points at it; null: as before. */
  preview(operation) {
    if (operation === this._previewed) return;
    this._previewed = operation;
    this._reset();
  }

  /** Mean the next operation that is allowed here (1), or the one before (-1). */
  cycle(step) {
    if (!this.offers) return;
    const allowed = [...this.offers.keys()].filter((name) => this.offers.get(name).allowed);
    if (!allowed.length) return;
    const at = allowed.indexOf(this.meant);
    const next = allowed[at < 0 ? (step > 0 ? 0 : allowed.length - 1)
      : (at + step + allowed.length) % allowed.length];
    if (this.armed) this.armed = next;
    else this._picked = next;
    this._reset();
  }

  /** Do what is meant here; if that is not known yet, as soon as it is. */
  act() {
    if (this.halfedge < 0) this._card.notify("refused", "Point at a half-edge first.");
    else if (this.ghost) this._card.operate(this.ghost.operation, this.halfedge);
    else if (this.offers) this._card.notify("refused", this._refusal());
    else this._acting = true;
  }

  /** The mesh has changed, or the agent has begun or ended: what was known is of the past. */
  renew() {
    const { replica } = this._card;
    if (this.halfedge >= 0 && !replica.live(this.halfedge)) {
      // who walks by keyboard goes on from the same place
      this.halfedge = this.pinned && this._place ? halfedgeNear(replica, ...this._place) : -1;
    }
    this._forget();
    this._card.pointed();
  }

  /** An answer of Python. */
  receive(content, buffers) {
    const asked = this._asked;
    if (!asked || content.reply !== asked.id) return;
    this._asked = null;
    if (content.halfedge === this.halfedge && content.halfedge >= 0) {
      this._answered = this._question();
      this._offer(content.offers);
      const of = asked.operation === this.wanted;
      this.ghost = of ? ghostOf(content, buffers) : null;
      if (!of) this._answered = "";
      this._card.pointed();
      if (of && this._acting) {
        this._acting = false;
        this.act();
      }
    }
    this.request();
  }

  /** What was asked with this id has been refused; returns whether that was a question of ours:
   * then the mesh has gone on meanwhile, which is nothing to tell a person.
   */
  refused(id) {
    if (!this._asked || this._asked.id !== id) return false;
    this._asked = null;
    return true;
  }

  /** Ask Python what there is to know, unless it is known or asked already. */
  request() {
    const card = this._card;
    if (card.readOnly || card.agentBusy || this.halfedge < 0) return;
    if (this._question() === this._answered) return;
    const now = performance.now();
    if (this._asked && now - this._asked.at < ANSWER_TIMEOUT) return;
    const fields = { halfedge: this.halfedge, operation: this.wanted };
    this._asked = { id: card.link.send("hover", fields), at: now, ...fields };
  }

  /** Ask now for what will be here once the operation under way is done, while `waiting()`.
   *
   * This saves a way to Python and back. And Jupyter's server holds a small message back until the
   * browser has acknowledged the one before, which takes 40 ms if it sends nothing meanwhile.
   */
  anticipate(waiting, times = ANTICIPATE.times) {
    if (times === 0) return;
    setTimeout(() => {
      if (!waiting()) return;
      this._asked = null;
      this._answered = "";
      this.request();
      this.anticipate(waiting, times - 1);
    }, ANTICIPATE.after);
  }

  /** Keep the offers; the same ones stay the same object, so that an open menu stays as it is. */
  _offer(offers) {
    const key = JSON.stringify(offers);
    if (this.offers && key === this._offersKey) return;
    this._offersKey = key;
    this.offers = new Map(offers.map((offer) => [offer.operation, offer]));
  }

  _question() {
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
