// Buttons over the canvas: zoom in, zoom out, fit, and help on mouse and keys.

import { button, icon, node } from "../dom.js";
import { KEY_HELP, MOUSE_HELP } from "../input/shortcuts.js";

export class ZoomButtons {
  constructor(card, stage) {
    this._card = card;
    this._help = null;
    const tool = (label, content, act) => {
      const made = button("mw-stage-tool", label, { act });
      made.append(content);
      return made;
    };
    this._question = tool("Mouse and keys (?)", icon("help"), () => this.toggle());
    this._question.setAttribute("aria-expanded", "false");
    stage.append(node("div", "mw-stage-tools", { role: "toolbar", "aria-label": "View" },
      tool("Zoom in (+)", zoomSign(true), () => card.stage.zoom(1.25)),
      tool("Zoom out (\u2212)", zoomSign(false), () => card.stage.zoom(0.8)),
      tool("Fit the mesh (0)", icon("fit"), () => card.stage.fit()),
      this._question));
    this._stage = stage;
  }

  /** Show or hide the list of keys. */
  toggle() {
    if (this._help) {
      this.close();
      return;
    }
    const rows = (list) => list.flatMap(([keys, words]) => [
      node("dt", "", {}, ...keys.split(" ").map((one) => node("kbd", "mw-key", {}, one))),
      node("dd", "", {}, words),
    ]);
    const mouse = MOUSE_HELP.flatMap(([gesture, words]) => [
      node("dt", "mw-help-mouse", {}, gesture), node("dd", "", {}, words),
    ]);
    this._help = node("div", "mw-help", { role: "dialog", "aria-label": "Mouse and keys", tabindex: "-1" },
      node("div", "mw-help-columns", {},
        node("dl", "", {}, ...mouse), node("dl", "", {}, ...rows(KEY_HELP))));
    this._help.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      event.stopPropagation();
      this.close();
      this._question.focus();
    });
    this._stage.append(this._help);
    this._question.setAttribute("aria-expanded", "true");
    this._help.focus({ preventScroll: true });
  }

  /** Hide the list; returns whether it was there. */
  close() {
    if (!this._help) return false;
    this._help.remove();
    this._help = null;
    this._question.setAttribute("aria-expanded", "false");
    return true;
  }
}

function zoomSign(closer) {
  const sign = icon("close");
  sign.firstChild.setAttribute("d", closer ? "M10 4.5v11 M4.5 10h11" : "M4.5 10h11");
  return sign;
}
