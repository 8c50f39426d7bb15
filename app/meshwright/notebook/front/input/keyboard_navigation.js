// Keyboard navigation between half-edges and between irregular vertices.

import { edgeLength } from "../mesh/derived.js";
import { halfedgeNear } from "../mesh/picking.js";

const KEEP_IN_VIEW = 48;
const REVEALED_SIZE = 120;

export class KeyboardNavigation {
  constructor(card) {
    this._card = card;
    this._vertex = -1;
  }

  /** To the next half-edge of the element (1), or the one before (-1). */
  along(step) {
    const { replica } = this._card;
    const h = this._here();
    if (h >= 0) this._go(step > 0 ? replica.next(h) : replica.prev(h));
  }

  /** To the other side of the edge. */
  across() {
    const { replica } = this._card;
    const h = this._here();
    if (h < 0) return;
    if (replica.twin[h] < 0) this._card.notify("info", "A boundary edge has no other side.");
    else this._go(replica.twin[h]);
  }

  /** To a half-edge at the next irregular vertex (1) or the previous one (-1), in reading order. */
  toIrregular(step) {
    const { replica, derived } = this._card;
    const found = inReadingOrder(replica, derived);
    if (!found.length) {
      this._card.notify("info", "Every vertex is regular.");
      return;
    }
    const at = found.indexOf(this._vertex);
    const place = at < 0 ? (step > 0 ? 0 : found.length - 1) : (at + step + found.length) % found.length;
    const vertex = this._vertex = found[place];
    const halfedge = replica.origin.indexOf(vertex);
    const reach = Math.max(...replica.around(halfedge).map((h) => edgeLength(replica, h)));
    const [x, y] = replica.place(vertex);
    this._card.stage.reveal(x, y, reach, REVEALED_SIZE);
    this._go(halfedge, `Irregular vertex ${place + 1} of ${found.length}. `);
  }

  /** The current half-edge; without one, -1, and go to the one in the middle of the view. */
  _here() {
    const { replica, hoverState, view } = this._card;
    if (replica.live(hoverState.halfedge)) return hoverState.halfedge;
    this._go(halfedgeNear(replica, view.x, view.y));
    return -1;
  }

  _go(halfedge, before = "") {
    if (halfedge < 0) return;
    this._card.pin(halfedge);
    this._card.stage.keepInView(halfedge, KEEP_IN_VIEW);
    this._card.announceSoon(before);
  }
}

/** Irregular vertices from the top down in bands, so that neighbours are consecutive. */
function inReadingOrder(replica, derived) {
  const band = Math.max(3 * derived.typical, 1e-9);
  const row = (v) => Math.floor(-replica.places[2 * v + 1] / band);
  return [...derived.irregular].sort(
    (a, b) => row(a) - row(b) || replica.places[2 * a] - replica.places[2 * b],
  );
}
