// Messages over the lower edge of the canvas, the current half-edge in the corner, and both as live
// regions for screen readers.

import { button, icon, node, setText } from "../dom.js";

const NOTICE_TIME = { refused: 5000, info: 3500, failed: 60000, hint: 2500 };
const ANNOUNCED_AFTER = 250;
const WAITING_AFTER = 700;
const SILENT_AFTER = 6000;

export class Notice {
  constructor(stage) {
    this._timers = { hide: 0, announce: 0, wait: 0 };
    this._text = node("span", "mw-notice-text");
    this._close = button("mw-notice-close", "Close this message", { sign: "close", act: () => this.hide() });
    this._box = node("div", "mw-notice", { hidden: true }, icon("alert", 16), this._text, this._close);
    this._live = node("div", "mw-unseen", { "aria-live": "polite", role: "status" });
    this._walk = node("div", "mw-unseen", { "aria-live": "polite" });
    this._where = node("div", "mw-where", { "aria-hidden": "true" });
    this._waiting = node("div", "mw-waiting", { hidden: true },
      node("span", "mw-waiting-dot"), node("span", "mw-waiting-text"));
    stage.append(this._where, this._waiting, this._box, this._live, this._walk);
  }

  /** Show a sentence for a while; tone "refused", "info", "failed" or "hint" (usage). */
  show(tone, sentence) {
    this._box.dataset.tone = tone;
    this._box.hidden = false;
    this._close.hidden = tone !== "failed";
    this._text.textContent = sentence;
    if (tone !== "hint") this._live.textContent = sentence;
    clearTimeout(this._timers.hide);
    this._timers.hide = setTimeout(() => this.hide(), NOTICE_TIME[tone] || NOTICE_TIME.info);
  }

  hide() {
    clearTimeout(this._timers.hide);
    this._box.hidden = true;
    this._live.textContent = "";
  }

  /** Show the current half-edge. */
  where(text) {
    setText(this._where, text);
  }

  /** Announce the current half-edge to screen readers; only the last of a quick series. */
  announce(makeText) {
    clearTimeout(this._timers.announce);
    this._timers.announce = setTimeout(() => {
      this._walk.textContent = makeText();
    }, ANNOUNCED_AFTER);
  }

  /** Show after a delay that a request is unanswered, or (false) hide that. */
  wait(waits, empty) {
    clearTimeout(this._timers.wait);
    this._waiting.hidden = true;
    if (!waits) return;
    this._timers.wait = setTimeout(() => {
      this._showWaiting("Waiting for Python\u2026");
      this._timers.wait = setTimeout(() => {
        this._showWaiting(empty
          ? "Python does not answer: run this cell again to see the mesh."
          : "Python is busy, or its kernel has stopped.");
      }, SILENT_AFTER);
    }, WAITING_AFTER);
  }

  _showWaiting(text) {
    this._waiting.hidden = false;
    this._waiting.lastChild.textContent = text;
  }

  release() {
    for (const timer of Object.values(this._timers)) clearTimeout(timer);
  }
}
