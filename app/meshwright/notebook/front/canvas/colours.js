// The colours of the card as it is now, read from its CSS variables once after each change.

import { COLOUR_NAMES } from "../generated/constants.js";

export class Colours {
  constructor() {
    this.theme = ""; // none: the card is not on the page yet
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

  /** The colour of a change of s: the accent for better, that of warnings for worse. */
  ofChange(change) {
    if (!change) return this.muted;
    return change < 0 ? this.accent : this.warning;
  }
}
