// The colours of the card, read from its CSS variables after each change of theme.

import { COLOUR_NAMES } from "../generated/constants.js";

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

  /** The colour of a change of s: accent for an improvement, warning otherwise. */
  ofChange(change) {
    if (!change) return this.muted;
    return change < 0 ? this.accent : this.warning;
  }
}
