// The menus at the pointer: the operations of a half-edge, and what there is to do with a vertex.

/** Everything that can be done at a half-edge, with what it would change and why it may not be. */
class OperationMenu {
  constructor(card, halfedge, { x, y, touch }) {
    this._card = card;
    this.halfedge = halfedge;
    const { mirror } = card;
    this._ends = [mirror.origin[halfedge], mirror.target(halfedge)];
    this._popup = new Popup(card, `Half-edge ${this._ends.join(" \u2192 ")}`, {
      touch,
      closed: () => {
        card.pointing.preview(null);
        card.menu = null;
      },
    });
    this._fill();
    this._popup.show(x, y);
  }

  get element() {
    return this._popup.root;
  }

  close(focus = true) {
    this._popup.close(focus);
  }

  /** Offers have come, or are others. */
  refresh() {
    const { mirror, pointing } = this._card;
    const same = mirror.live(this.halfedge) && mirror.origin[this.halfedge] === this._ends[0]
      && mirror.target(this.halfedge) === this._ends[1];
    if (!same || pointing.halfedge !== this.halfedge) this.close();
    else if (pointing.offers !== this._offers) this._fill();
  }

  _fill() {
    const { mirror, pointing, palette } = this._card;
    this._offers = pointing.offers;
    const focused = this._popup.rows.findIndex((row) => row.element.matches(":focus"));
    this._popup.clear();
    for (const info of mirror.catalogue) {
      const offer = this._offers ? this._offers.get(info.operation) : null;
      const refused = offer ? !offer.allowed : false;
      const known = offer && offer.change !== null;
      const change = node("span", "mw-change", {}, known ? signed(offer.change) : "");
      if (known) change.style.color = palette.ofChange(offer.change);
      const reason = refused ? asSentence(offer.reason) : "";
      this._popup.addRow({
        label: `${info.title}${known ? `, s ${signed(offer.change)}` : ""}${reason ? `. Not here: ${reason}` : ""}`,
        parts: [
          node("span", "mw-row-line", {},
            node("span", "mw-row-title", {}, info.title), change, node("kbd", "mw-key", {}, info.key)),
          reason ? node("span", "mw-reason", {}, reason) : null,
        ],
        disabled: refused || !offer,
        key: info.key,
        act: () => this._card.operate(info.operation, this.halfedge),
        pointed: () => pointing.preview(refused || !offer ? null : info.operation),
      });
    }
    if (focused >= 0) this._popup.focusRow(focused);
  }
}

/** Desired degree, corner and lock of the vertex where a half-edge starts. */
class VertexMenu {
  constructor(card, halfedge, { x, y, touch }) {
    const { mirror } = card;
    this._card = card;
    this.vertex = mirror.origin[halfedge];
    this._revision = mirror.revision;
    const degree = mirror.degree(halfedge);
    const delta = mirror.delta[this.vertex];
    const flags = mirror.flags[this.vertex];
    const words = `Vertex ${this.vertex}: degree ${degree}, \u0394 ${signed(delta)}`;
    this._popup = new Popup(card, words, { touch, closed: () => (card.menu = null) });
    const desired = degree - delta;
    const choice = (title, checked, act) => this._popup.addRow({
      label: title, checked, act,
      parts: [node("span", "mw-row-line", {},
        node("span", "mw-check", {}, ...(checked ? [icon("check", 14)] : [])),
        node("span", "mw-row-title", {}, title))],
    });
    const wanted = new Set([desired - 1, desired, desired + 1].filter((d) => d >= 1));
    for (const d of wanted) {
      choice(`Desired degree ${d}`, d === desired, () => this._send("desired", { degree: d }));
    }
    const [corner, locked] = [(flags & FLAG_CORNER) !== 0, (flags & FLAG_LOCKED) !== 0];
    choice("Corner: it stays where it is", corner, () => this._send("corner", { on: !corner }));
    choice("Locked: nothing changes it", locked, () => this._send("lock", { on: !locked }));
    this._popup.show(x, y);
  }

  get element() {
    return this._popup.root;
  }

  close(focus = true) {
    this._popup.close(focus);
  }

  refresh() {
    if (this._card.mirror.revision !== this._revision) this.close();
  }

  _send(word, fields) {
    this._card.ask(word, { vertex: this.vertex, ...fields });
  }
}
