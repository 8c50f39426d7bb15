// The card: one view of a document. It joins the parts, hears the link and speaks to it.

import { Palette } from "./canvas/colours.js";
import { Stage } from "./canvas/stage.js";
import { node } from "./dom.js";
import { Pointing } from "./input/hover.js";
import { Walking } from "./input/keyboard_navigation.js";
import { Pointer } from "./input/pointer.js";
import { Keys } from "./input/shortcuts.js";
import { hostTheme, watchHost } from "./link/host_theme.js";
import { AgentPanel } from "./panels/agent_panel.js";
import { canvasLabel, described, meshName, placed } from "./panels/labels.js";
import { Levels } from "./panels/level_bar.js";
import { Menus } from "./panels/menus.js";
import { Notice } from "./panels/notice.js";
import { OperationsPanel } from "./panels/operations_panel.js";
import { ScorePanel } from "./panels/score_panel.js";
import { Timeline } from "./panels/timeline.js";
import { StageTools } from "./panels/zoom_buttons.js";

const WHEEL_HINT = /Mac|iPhone|iPad/.test(navigator.platform)
  ? "Hold \u2318 and scroll to zoom, or click the mesh first."
  : "Hold Ctrl and scroll to zoom, or click the mesh first.";
const MOST_TOUCH_HINTS = 2;
const TOUCH_HINT = "Two fingers move the mesh.";
const ANSWERED = ["hello", "operate", "undo", "redo", "smooth", "untangle", "clean_all", "take_hint"];

class Card {
  constructor(link, options) {
    this.link = link;
    this.palette = new Palette();
    this.wanted = options.theme || "auto";
    this._followers = [];
    this._pending = [];
    this._paints = 0;
    this._touchHints = 0;
    this._helloed = false;
    this._make(options.height || 464);
    this._unwatch = watchHost(() => this.retheme());
    this._arrival = new ResizeObserver(() => this._arrive());
    this._arrival.observe(this.root);
    this._onLost = (event) => this._focusMoved(event);
    this.root.addEventListener("focusout", this._onLost);
    link.onmessage = (content, buffers) => this.receive(content, buffers);
    this.retheme();
    this.ask("hello");
  }

  _make(height) {
    this.root = node("div", "meshwright", {
      role: "region", "aria-label": "Mesh", "data-lm-suppress-shortcuts": "true",
    });
    this.root.meshwright = this;
    const place = node("div", "mw-stage");
    place.style.height = `${height}px`;
    const under = node("div", "mw-timeline");
    const above = node("div", "mw-levels");
    this.pointing = new Pointing(this);
    this.menus = new Menus(this);
    this.stage = new Stage(place, this.palette, () => this._onPainted());
    this.tools = new StageTools(this, place);
    this.notice = new Notice(place);
    this.score = new ScorePanel(this);
    this.operations = new OperationsPanel(this);
    this.agent = new AgentPanel(this);
    this.walking = new Walking(this);
    this.panel = node("div", "mw-panel", {}, this.score.root, this.operations.root, this.agent.root);
    this.root.append(
      above,
      node("div", "mw-body", {},
        node("div", "mw-main", {}, place, under),
        node("div", "mw-side", {}, node("div", "mw-side-scroll", {}, this.panel))),
    );
    this.pointer = new Pointer(this, this.stage.surface);
    this._keys = new Keys(this);
    this.stage.surface.addEventListener("keydown", (event) => {
      if (!this._keys.press(event)) return;
      event.preventDefault();
      event.stopPropagation();
    });
    this.timeline = new Timeline(under, this);
    this.levels = new Levels(above, this);
  }

  release() {
    this._unwatch();
    this._arrival.disconnect();
    this.menus.close(false);
    for (const part of [this.pointer, this.notice, this.stage, this.timeline, this.levels]) {
      if (part && part.release) part.release();
    }
    this.link.onmessage = () => {};
    this.link.close();
    this.root.remove();
    delete this.root.meshwright;
  }

  // What there is

  get mirror() {
    return this.stage.work.mirror;
  }

  get facts() {
    return this.stage.work.facts;
  }

  get view() {
    return this.stage.view;
  }

  get readOnly() {
    return this.link.readOnly || this.mirror.readOnly;
  }

  get agentBusy() {
    return this.agent.busy;
  }

  /** Whether the canvas has the focus. */
  get focused() {
    return this.root.getRootNode().activeElement === this.stage.surface;
  }

  /** A colour of the theme: "accent", "accent_soft" or "accent-soft". */
  colour(name) {
    return this.palette[name.replace(/-/g, "_")];
  }

  /** Call back after every change of theme. */
  follow(callback) {
    this._followers.push(callback);
  }

  /** For tests and scripts: where on the page {x, y} a pointer is on a half-edge, just inside its
   * element; null if there is none. It may lie outside of the window or of the canvas.
   */
  screenOf(halfedge) {
    if (!this.mirror.live(halfedge)) return null;
    const [x, y] = this.stage.middle(halfedge);
    const box = this.stage.surface.getBoundingClientRect();
    return { x: box.left + x, y: box.top + y };
  }

  // Messages

  /** Ask Python for something that it answers, or not. */
  ask(word, fields = {}) {
    if (this.readOnly && !["hello", "go_to", "level"].includes(word)) return;
    const id = this.link.send(word, fields);
    if (ANSWERED.includes(word)) {
      this._pending.push(id);
      if (this._pending.length === 1) this.notice.wait(true, this.mirror.revision < 0);
    }
  }

  receive(content, buffers) {
    const mine = content.asked === undefined || content.asked === this.link.view;
    if (mine && Number.isInteger(content.reply)) this._answer(content.reply);
    const receivers = {
      state: () => this._onState(content, buffers),
      patch: () => this._onPatch(content, buffers),
      ghost: () => this.pointing.receive(content, buffers),
      agent: () => this._onAgent(content),
      notice: () => this._onNotice(content),
      level: () => this.levels.update(content),
    };
    if (receivers[content.say]) receivers[content.say]();
  }

  _answer(id) {
    if (!this._pending.length) return;
    this._pending = this._pending.filter((asked) => asked > id);
    if (!this._pending.length) this.notice.wait(false);
  }

  _onState(content, buffers) {
    this._helloed = false;
    this.stage.load(content, buffers);
    this._onChanged();
  }

  _onPatch(content, buffers) {
    if (this.stage.patch(content, buffers)) this._onChanged();
    else if (!this._helloed) {
      this._helloed = true; // something was missed: begin again, once
      this.ask("hello");
    }
  }

  _onChanged() {
    const { head } = this.mirror;
    this.score.update(head);
    this.timeline.update(head);
    this.root.setAttribute("aria-label", meshName(head));
    this.stage.surface.setAttribute("aria-label", canvasLabel(head));
    if (this.pointer.place && !this.pointing.pinned && !this.menus.open) {
      this.pointing.halfedge = this.pointer.halfedge();
    }
    this.pointing.renew();
    this.menus.refresh();
  }

  _onAgent(content) {
    const busy = this.agentBusy;
    this.agent.update(content);
    this.root.dataset.agent = content.state;
    if (busy !== this.agentBusy) this.pointing.renew();
  }

  _onNotice({ tone, sentence, reply }) {
    const stale = this.pointing.refused(reply);
    if (!stale || tone === "failed") this.say(tone, sentence);
  }

  /** Tell a person a sentence; tone "refused", "said", "failed" or "hint". */
  say(tone, sentence) {
    this.notice.show(tone, sentence);
  }

  /** Do an operation at a half-edge, if it is still the one that was meant. */
  operate(operation, halfedge) {
    const { mirror } = this;
    if (!mirror.live(halfedge)) return;
    const ends = [mirror.origin[halfedge], mirror.target(halfedge)];
    this.ask("operate", { operation, halfedge, ends });
    const id = this._pending[this._pending.length - 1];
    this.pointing.anticipate(() => this._pending.includes(id));
  }

  operateByKey(operation) {
    if (this.pointing.halfedge < 0) this.say("refused", "Point at a half-edge first, then press the key.");
    else this.operate(operation, this.pointing.halfedge);
  }

  // Pointing

  pick(at, reach) {
    return this.stage.pick(at, reach);
  }

  hover(halfedge, at) {
    const badge = this.stage.overlay.badges.at(...at);
    this.stage.surface.style.cursor = badge >= 0 ? "pointer" : "";
    if (badge >= 0) this.meanHint(badge);
    else if (!this.menus.open) {
      this.pointing.preview(null);
      this.pointing.point(halfedge);
    }
  }

  /** The mouse has left the canvas. */
  left() {
    if (!this.menus.open && !this.pointing.pinned) this.pointing.point(-1);
  }

  /** Point at a half-edge by other means than the mouse. */
  pin(halfedge) {
    this.pointing.point(halfedge, true);
    this.pointing.pinned = halfedge >= 0;
  }

  click(halfedge, at, touch) {
    this.tools.close();
    const badge = this.stage.overlay.badges.at(...at);
    if (badge >= 0) {
      this.agent.take(badge);
      return;
    }
    this.pointing.preview(null);
    this.pointing.point(halfedge);
    if (halfedge < 0 || this.readOnly) return;
    if (this.pointing.armed) this.operate(this.pointing.armed, halfedge);
    else this.menus.openOperations(halfedge, at, touch);
  }

  doubleClick(halfedge) {
    if (halfedge >= 0 && this.pointing.armed) return;
    this.menus.close();
    this.stage.fit();
  }

  cycle(step) {
    this.pointing.cycle(step);
    this.announceSoon();
  }

  /** Something about what is pointed at is another: show it, and ask for what is not known. */
  pointed() {
    const { pointing, mirror, stage } = this;
    const info = mirror.catalogue.find((one) => one.operation === pointing.meant);
    Object.assign(stage.shown, {
      halfedge: pointing.halfedge, ghost: pointing.ghost,
      title: info && !this.menus.open ? info.title : "", // an open menu says it already
    });
    this.root.dataset.halfedge = pointing.halfedge;
    this.root.dataset.meant = pointing.meant || "";
    this.operations.update();
    this.menus.refresh();
    const h = pointing.halfedge;
    this.notice.where(h < 0 ? "" : placed(mirror, pointing));
    stage.repaint();
    pointing.ask();
  }

  // Hints

  showHints(hints) {
    Object.assign(this.stage.shown, { hints, meant: 0 });
    this.stage.repaint();
  }

  /** Bring a hint to the front, with its ghost. */
  meanHint(index) {
    const hint = this.agent.hints[index];
    this.stage.shown.meant = index;
    this.pin(hint.halfedge);
    this.pointing.preview(hint.operation);
    this.stage.repaint();
  }

  // Words

  tellWheel() {
    this.say("hint", WHEEL_HINT);
  }

  /** One finger has scrolled the page: nobody wants to read that every time. */
  tellTouch() {
    this._touchHints += 1;
    if (this._touchHints <= MOST_TOUCH_HINTS) this.say("hint", TOUCH_HINT);
  }

  /** Say what is pointed at, once the keys rest. */
  announceSoon(before = "") {
    this.notice.speak(() => before + described(this));
  }

  toggleHelp() {
    this.tools.toggle();
  }

  /** Put down what is in hand, one thing at a time. */
  escape() {
    if (this.menus.close()) return;
    if (this.tools.close()) this.focusCanvas();
    else if (this.pointing.armed) this.pointing.arm(this.pointing.armed);
    else if (!this.agent.escape() && this.pointing.pinned) this.pointing.point(-1);
  }

  focusCanvas() {
    this.stage.surface.focus({ preventScroll: true });
  }

  _focusMoved(event) {
    const inside = event.relatedTarget && this.root.contains(event.relatedTarget);
    if (!inside && this.pointing.pinned && !this.menus.open) this.pointing.point(-1);
  }

  // Looks

  retheme() {
    const theme = this.wanted === "auto" ? hostTheme() : this.wanted;
    this.root.dataset.theme = theme;
    this._arrive();
  }

  /** Some hosts put the card on the page only after it was made: then the colours are known. */
  _arrive() {
    if (this.root.isConnected && this.palette.theme !== this.root.dataset.theme) this.recolour();
  }

  /** Read the colours again; they are known once the card is on the page. */
  recolour() {
    this.palette.read(this.root);
    this.stage.recolour();
    this.operations.update();
    for (const callback of this._followers) callback();
  }

  /** Take over what a model says. */
  configure({ height, theme }) {
    this.stage.element.style.height = `${height}px`;
    this.wanted = theme;
    this.retheme();
  }

  _onPainted() {
    this._paints += 1;
    this.root.dataset.revision = this.mirror.revision;
    this.root.dataset.painted = this._paints;
  }
}

/** Show what `link` tells in `element`; returns the Card. options: {height, theme}. */
export function mount(element, link, options = {}) {
  const card = new Card(link, options);
  element.append(card.root);
  card.retheme();
  return card;
}
