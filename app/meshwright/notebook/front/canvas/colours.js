// The colours of the card, read from its CSS variables after each change of theme.

import {
  COLOUR_NAMES, NAME_HUES, QUALITY_SCALES, QUALITY_STOPS, REGION_HUES, REGION_SHARE, SWATCH_SHARE,
} from "../generated/constants.js";

export class Colours {
  constructor() {
    this.theme = ""; // empty until the card is in the page
  }

  /** Read again from `element`. */
  read(element) {
    const style = getComputedStyle(element);
    this.theme = element.dataset.theme;
    for (const name of COLOUR_NAMES) {
      this[name] = style.getPropertyValue(`--mw-${name.replace(/_/g, "-")}`).trim();
    }
    this.font = style.fontFamily;
  }

  /** The fill of a region of a mesh with several, as meshwright.graphics.theme.region_fills. */
  ofRegion(region) {
    return mixed(this.fill, REGION_HUES[region % REGION_HUES.length], REGION_SHARE);
  }

  /** The same where it covers a few pixels only, as region_swatches there. */
  swatchOf(region) {
    return mixed(this.fill, REGION_HUES[region % REGION_HUES.length], SWATCH_SHARE);
  }

  /** The colour of a named side by its number, as name_colours there. */
  ofName(number) {
    const turn = Math.floor(number / NAME_HUES.length);
    return mixed(NAME_HUES[number % NAME_HUES.length], this.background, Math.min(0.6, 0.3 * turn));
  }

  /** The colours [r, g, b] of the scale of a measure, at QUALITY_STOPS. */
  qualityScale() {
    const colours = QUALITY_SCALES[this.theme] || QUALITY_SCALES.light;
    return colours.map((colour) => [1, 3, 5].map((at) => parseInt((colour || this.fill).slice(at, at + 2), 16)));
  }

  /** The fill of an element with this value of a measure. */
  ofQuality(value, scale = this.qualityScale()) {
    const known = Math.min(Math.max(value, 0), 1);
    const i = Math.max(0, QUALITY_STOPS.findIndex((stop) => known <= stop) - 1);
    const share = (known - QUALITY_STOPS[i]) / (QUALITY_STOPS[i + 1] - QUALITY_STOPS[i]);
    const mixed = scale[i].map((a, channel) => Math.round(a + share * (scale[i + 1][channel] - a)));
    return `rgb(${mixed.join(", ")})`;
  }

  /** The fill of a half-edge's element. */
  fillOf(replica, halfedge) {
    return replica.regions.length > 1 ? this.ofRegion(replica.region[replica.element(halfedge)]) : this.fill;
  }

  /** The colour of a change of s: accent for an improvement, warning otherwise. */
  ofChange(change) {
    if (!change) return this.muted;
    return change < 0 ? this.accent : this.warning;
  }
}

/** A colour #rrggbb with a share of another one. */
function mixed(colour, other, share) {
  const parts = [1, 3, 5].map((at) => {
    const [a, b] = [colour, other].map((one) => parseInt(one.slice(at, at + 2), 16));
    return Math.round(a + share * (b - a));
  });
  return `rgb(${parts.join(", ")})`;
}
