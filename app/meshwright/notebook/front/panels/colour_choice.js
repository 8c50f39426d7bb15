// What elements are coloured by, and its legend over the stage.

import { node, setText } from "../dom.js";
import { QUALITY_STOPS } from "../generated/constants.js";

const CHOICES = [["", "Plain elements"], ["jacobian", "Colour by scaled Jacobian"], ["shape", "Colour by shape"]];

export class ColourChoice {
  constructor(card, stage) {
    this._card = card;
    this._stage = stage;
    this.root = node("select", "mw-select mw-colour", {
      "aria-label": "Colour of elements", title: "What elements are coloured by",
    }, ...CHOICES.map(([value, label]) => node("option", "", { value }, label)));
    this.root.addEventListener("change", () => this._choose());
    this._title = node("span", "mw-legend-title");
    this._bar = node("div", "mw-legend-bar");
    this._legend = node("div", "mw-legend", { hidden: true }, this._title, this._bar,
      node("div", "mw-legend-scale", {}, ...["0", ".5", "1"].map((text) => node("span", "", {}, text))));
    stage.element.append(this._legend);
    card.follow(() => this._paint());
  }

  /** Show the numbers of a head. */
  update({ shape }) {
    const measure = this.root.value;
    if (!measure || !shape) return;
    const name = measure === "jacobian" ? "Scaled Jacobian" : "Shape";
    const worst = measure === "jacobian" ? shape.words : shape.flattest;
    setText(this._title, `${name}: worst ${worst}`);
  }

  _choose() {
    const measure = this.root.value;
    this._stage.colourBy(measure);
    this._legend.hidden = !measure;
    if (this._card.replica.head) this.update(this._card.replica.head);
    this._paint();
  }

  _paint() {
    const stops = this._card.colours.qualityScale().map((rgb, i) => (
      `rgb(${rgb.join(",")}) ${100 * QUALITY_STOPS[i]}%`));
    this._bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
  }
}
