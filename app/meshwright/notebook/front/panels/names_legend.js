// The names of sides and regions, each beside its colour, over the stage.

import { node } from "../dom.js";

/** Names that are listed; of more the last row says how many. */
const ROWS = 12;

export class NamesLegend {
  constructor(card, place) {
    this._card = card;
    this._key = "";
    this.root = node("ul", "mw-names", { hidden: true, "aria-label": "Names of sides and regions" });
    place.append(this.root);
    card.follow(() => this._show());
  }

  /** The mesh, or its names, may have changed. */
  update({ sides = [] }) {
    const { regions } = this._card.replica;
    const painter = this._card.stage.painter;
    const before = JSON.stringify(painter.sides);
    painter.sides = sides;
    if (before !== JSON.stringify(sides)) {
      painter.forget();
      this._card.stage.repaint();
    }
    const key = JSON.stringify([sides.map(([name]) => name), regions]);
    if (key === this._key) return;
    this._key = key;
    this._show();
  }

  _show() {
    const { replica, colours, stage } = this._card;
    const rows = stage.painter.sides.map(([name], i) => [name, colours.ofName(i), "mw-name-side"]);
    if (replica.regions.length > 1 || replica.regions[0]) {
      replica.regions.forEach((name, i) => {
        const colour = replica.regions.length > 1 ? colours.swatchOf(i) : colours.fill;
        rows.push([name || `Region ${i + 1}`, colour, "mw-name-region"]);
      });
    }
    this.root.hidden = !rows.length;
    const shown = rows.slice(0, ROWS).map(([name, colour, kind]) => {
      const swatch = node("span", `mw-name-swatch ${kind}`);
      swatch.style.background = colour;
      return node("li", "mw-name", { title: name }, swatch, node("span", "mw-name-text", {}, name));
    });
    if (rows.length > ROWS) shown.push(node("li", "mw-name", {}, `and ${rows.length - ROWS} more`));
    this.root.replaceChildren(...shown);
  }
}
