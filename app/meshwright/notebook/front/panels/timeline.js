// The timeline under the canvas: the score of every state as a step curve above the optimum, a slider
// over the states, and playback.
//
// It sends `go_to` requests only, one at a time: while the slider moves faster than answers arrive,
// states in between are skipped. The mark follows the pointer at once, the mesh later.

import { button, drawn, icon, node } from "../dom.js";
import { ScoreSeries, CurveFrame, formatNumber } from "../mesh/score_series.js";
import { paintScoreCurve } from "./score_curve.js";

const HEIGHT = 72;
const MARGINS = { left: 48, right: 16, top: 10, bottom: 20 };
/** Playback speeds in states per second, and the maximal number of requests per second. */
const SPEEDS = [1, 2, 5, 10, 25, 100];
const MOST_FRAMES = 20;
/** Pixels that a finger moves before that counts as dragging. */
const TOUCH_SLACK = 8;
/** Milliseconds after which a request is given up. */
const TIMEOUT = 2000;

export class Timeline {
  constructor(element, card) {
    this.card = card;
    this.series = new ScoreSeries();
    this.cursor = 0;
    this.playing = false;
    this._wanted = null;
    this._flight = null;
    this._hovered = -1;
    this._painting = 0;
    this._make(element);
    this._observer = new ResizeObserver(() => this.repaint());
    this._observer.observe(this.slider);
    card.follow(() => this.repaint());
    this._refresh();
  }

  _make(element) {
    element.replaceChildren();
    this.root = element;
    this.slider = node("div", "mw-timeline-curve", {
      role: "slider", tabindex: "0", "aria-label": "History of the mesh", "aria-valuemin": "0",
    });
    this.canvas = node("canvas", "", { "aria-hidden": "true" });
    this.slider.append(this.canvas);
    const row = node("div", "mw-timeline-row");
    const button = (name, label, act) => {
      const made = node("button", "mw-timeline-button", {
        type: "button", "aria-label": label, title: label,
      });
      made.append(timelineIcon(name));
      made.addEventListener("click", act);
      row.append(made);
      return made;
    };
    this.first = button("first", "To the start", () => this.goTo(0));
    this.back = button("back", "One step back", () => this.goTo(this.shown - 1));
    this.play = button("play", "Play the history", () => this.toggle());
    this.ahead = button("ahead", "One step forward", () => this.goTo(this.shown + 1));
    this.end = button("end", "To the last state", () => this.goTo(this.last));
    this.best = button("best", "To the best state", () => this.goTo(this.series.best));
    this.speed = node("select", "mw-timeline-speed", {
      "aria-label": "Playback speed", title: "Playback speed",
    });
    for (const speed of SPEEDS) this.speed.append(new Option(speedLabel(speed), speed, speed === 2, speed === 2));
    this.words = node("div", "mw-timeline-words");
    this.legend = node("div", "mw-timeline-legend", { "aria-hidden": "true" });
    this.legend.append("● you  ◇ agent");
    const line = node("div", "mw-timeline-line");
    line.append(this.words);
    row.append(this.speed, this.legend);
    element.append(line, this.slider, row);
    this._listen();
  }

  _listen() {
    const { slider } = this;
    const state = (event) => this.frame.state(event.clientX - slider.getBoundingClientRect().left);
    let began = null; // where a finger came down that may scroll the page
    slider.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || this.empty || this.locked || !this.frame) return;
      slider.setPointerCapture(event.pointerId);
      this.stop();
      began = event.pointerType === "touch" ? [event.clientX, event.clientY] : null;
      if (!began) this.goTo(state(event));
    });
    slider.addEventListener("pointermove", (event) => {
      if (this.empty || !this.frame) return;
      this.hover(event.pointerType === "touch" ? -1 : state(event));
      if (!slider.hasPointerCapture(event.pointerId)) return;
      if (began) {
        const [x, y] = [Math.abs(event.clientX - began[0]), Math.abs(event.clientY - began[1])];
        if (x < TOUCH_SLACK || x < y) return;
        began = null;
      }
      this.goTo(state(event));
    });
    slider.addEventListener("pointerup", (event) => {
      if (began && Math.abs(event.clientY - began[1]) < TOUCH_SLACK) this.goTo(state(event));
      began = null;
    });
    slider.addEventListener("pointercancel", () => {
      began = null;
    });
    slider.addEventListener("pointerleave", () => this.hover(-1));
    slider.addEventListener("keydown", (event) => this._key(event));
  }

  _key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || this.empty) return;
    const page = Math.max(1, Math.round(this.last / 20));
    const to = {
      ArrowLeft: this.shown - 1, ArrowDown: this.shown - 1, ArrowRight: this.shown + 1,
      ArrowUp: this.shown + 1, PageDown: this.shown - page, PageUp: this.shown + page,
      Home: 0, End: this.last,
    }[event.key];
    if (to !== undefined) this.goTo(to);
    else if (event.key === " ") this.toggle();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  // State

  /** Number of the last state. */
  get last() {
    return Math.max(this.series.length - 1, 0);
  }

  /** True while the history is empty. */
  get empty() {
    return this.last === 0;
  }

  /** True in a read-only view of a live mesh, which must not move through its history. */
  get locked() {
    return this.card.replica.readOnly && !this.card.link.readOnly;
  }

  /** The state of the mark: that of the slider, else that of the mesh. */
  get shown() {
    return this._wanted === null ? this.cursor : this._wanted;
  }

  /** Take over the history of a state or a patch. */
  update(head) {
    const last = this.last;
    const awaited = this._flight !== null && head.cursor === this._flight;
    const moved = head.cursor !== this.cursor;
    this.series.follow(head);
    this.cursor = head.cursor;
    if (this.playing && (this.last !== last || (moved && !awaited))) this.stop();
    if (awaited) this._landed();
    this._refresh();
    this.repaint();
  }

  // Moving

  /** Go to a state, and stop playback. */
  goTo(state) {
    this.stop();
    this._request(state);
  }

  _request(state) {
    const wanted = Math.min(Math.max(state, 0), this.last);
    if (wanted === this.shown || this.locked) return;
    this._wanted = wanted;
    if (this._flight === null) this._launch();
    this._refresh();
    this.repaint();
  }

  _launch() {
    this._flight = this._wanted;
    this._timeout = setTimeout(() => {
      this._flight = null;
      this._wanted = null;
      this.stop();
      this._refresh();
      this.repaint();
    }, TIMEOUT);
    this.card.link.send("go_to", { cursor: this._flight });
  }

  _landed() {
    clearTimeout(this._timeout);
    this._flight = null;
    if (this._wanted !== null && this._wanted !== this.cursor) this._launch();
    else this._wanted = null;
  }

  // Playing

  toggle() {
    if (this.playing) {
      this.stop();
      return;
    }
    if (this.empty || this.locked) return;
    this.playing = true;
    if (this.shown >= this.last) this._request(0);
    this._refresh();
    this._tick();
  }

  stop() {
    if (!this.playing) return;
    this.playing = false;
    clearTimeout(this._due);
    this._refresh();
  }

  _tick() {
    const speed = Number(this.speed.value);
    const pause = Math.max(1000 / speed, 1000 / MOST_FRAMES);
    this._due = setTimeout(() => {
      if (!this.playing) return;
      const idle = this._flight === null;
      if (idle && this.cursor >= this.last) {
        this.stop();
        return;
      }
      if (idle) this._request(this.cursor + Math.max(1, Math.round((speed * pause) / 1000)));
      this._tick();
    }, pause);
  }

  // Display

  hover(state) {
    if (state === this._hovered) return;
    this._hovered = state;
    this._refresh();
    this.repaint();
  }

  /** Update texts and buttons. */
  _refresh() {
    const { series, empty, last, shown, locked } = this;
    const looked = this._hovered >= 0 && this._hovered <= last ? this._hovered : shown;
    this.root.classList.toggle("mw-timeline-empty", empty);
    this.slider.setAttribute("aria-disabled", String(empty || locked));
    this.slider.setAttribute("aria-valuemax", last);
    this.slider.setAttribute("aria-valuenow", shown);
    this.slider.setAttribute("aria-valuetext", empty ? "no steps yet" : this.sentence(shown));
    this.words.textContent = empty ? "No steps yet. The scores will be drawn here." : this.sentence(looked);
    this.words.classList.toggle("mw-timeline-looked", looked !== shown);
    for (const made of [this.first, this.back]) made.disabled = locked || shown <= 0;
    for (const made of [this.ahead, this.end]) made.disabled = locked || shown >= last;
    this.best.disabled = locked || empty || shown === series.best;
    this.play.disabled = locked || empty;
    const label = this.playing ? "Pause" : "Play the history";
    if (this.play.title !== label) {
      this.play.title = label;
      this.play.setAttribute("aria-label", label);
      this.play.replaceChildren(timelineIcon(this.playing ? "pause" : "play"));
    }
    this.legend.hidden = empty || series.others === 0 || series.others === last;
  }

  /** "State 4 of 12, s 8 (−2), Flip left by you". */
  sentence(state) {
    const { series } = this;
    const best = state === series.best && state > 0 ? ", the best" : "";
    const where = `State ${formatNumber(state)} of ${formatNumber(this.last)}`;
    return `${where}, s ${formatNumber(series.scores[state])}${series.change(state)}, ${series.words(state)}${best}`;
  }

  repaint() {
    if (this._painting) return;
    this._painting = requestAnimationFrame(() => {
      this._painting = 0;
      this._paint();
    });
  }

  _paint() {
    if (this.empty || !this.slider.clientWidth) return;
    const ratio = devicePixelRatio || 1;
    const width = this.slider.clientWidth;
    const { left, right, top, bottom } = MARGINS;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(HEIGHT * ratio);
    this.frame = new CurveFrame(this.series, left, top, width - left - right, HEIGHT - top - bottom);
    const pen = this.canvas.getContext("2d");
    pen.scale(ratio, ratio);
    pen.font = `11px ${getComputedStyle(this.slider).fontFamily}`;
    paintScoreCurve(pen, this.frame, this.series, this.card, { shown: this.shown, hovered: this._hovered });
  }

  release() {
    clearTimeout(this._due);
    clearTimeout(this._timeout);
    cancelAnimationFrame(this._painting);
    this._observer.disconnect();
  }
}

/** Outlines in a square of 16; "play" is filled. */
const ICONS = {
  first: "M4 4v8 M11.5 4l-4 4 4 4",
  back: "M10 4L6 8l4 4",
  play: "M5 3.5v9l7.5-4.5z",
  pause: "M5.5 4v8 M10.5 4v8",
  ahead: "M6 4l4 4-4 4",
  end: "M12 4v8 M4.5 4l4 4-4 4",
  best: "M8 3l5 5-5 5-5-5z",
};

/** "2 steps/s". */
function speedLabel(speed) {
  return `${speed} step${speed === 1 ? "" : "s"}/s`;
}

function timelineIcon(name) {
  const icon = drawn(ICONS[name], { viewBox: "0 0 16 16" });
  if (name === "play") icon.firstChild.setAttribute("fill", "currentColor");
  return icon;
}
