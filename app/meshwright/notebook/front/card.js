// The card: one view of a document. It owns the parts, and exchanges messages with the link.

import { Colours } from "./canvas/colours.js";
import { Stage } from "./canvas/stage.js";
import { node } from "./dom.js";
import { HoverState } from "./input/hover.js";
import { KeyboardNavigation } from "./input/keyboard_navigation.js";
import { Pointer } from "./input/pointer.js";
import { Shortcuts } from "./input/shortcuts.js";
import { hostTheme, watchHost } from "./link/host_theme.js";
import { AgentPanel } from "./panels/agent_panel.js";
import { BlocksPanel } from "./panels/blocks_panel.js";
import { ColourChoice } from "./panels/colour_choice.js";
import { canvasLabel, described, meshName, placed } from "./panels/labels.js";
import { LevelBar } from "./panels/level_bar.js";
import { Menus } from "./panels/menus.js";
import { NamesLegend } from "./panels/names_legend.js";
import { Notice } from "./panels/notice.js";
import { OperationsPanel } from "./panels/operations_panel.js";
import { ScorePanel } from "./panels/score_panel.js";
import { Timeline } from "./panels/timeline.js";
import { ZoomButtons } from "./panels/zoom_buttons.js";

const WHEEL_HINT = /Mac|iPhone|iPad/.test(navigator.platform)
  ? "Hold \u2318 and scroll to zoom, or click the mesh first."
  : "Hold Ctrl and scroll to zoom, or click the mesh first.";
const MOST_TOUCH_HINTS = 2;
const TOUCH_HINT = "Two fingers move the mesh.";
const ANSWERED = [
  "hello", "operate", "undo", "redo", "smooth", "untangle", "clean_all", "take_hint", "chord_count",
  "export_blocks",
];

class Card {
  constructor(link, options) {
    this.link = link;
    this.colours = new Colours();
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
    this.request("hello");
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
    this.hoverState = new HoverState(this);
    this.menus = new Menus(this);
    this.stage = new Stage(place, this.colours, () => this._onPainted());
    this.zoomButtons = new ZoomButtons(this, place);
    this.notice = new Notice(place);
    this.colourChoice = new ColourChoice(this, this.stage);
    this.names = new NamesLegend(this, place);
    this.score = new ScorePanel(this);
    this.operations = new OperationsPanel(this);
    this.agent = new AgentPanel(this);
    this.blocks = new BlocksPanel(this);
    this.navigation = new KeyboardNavigation(this);
    this.panel = node("div", "mw-panel", {},
      this.score.root, this.operations.root, this.agent.root, this.blocks.root);
    this.root.append(
      above,
      node("div", "mw-body", {},
        node("div", "mw-main", {}, place, under),
        node("div", "mw-side", {}, node("div", "mw-side-scroll", {}, this.panel))),
    );
    this.pointer = new Pointer(this, this.stage.surface);
    this._shortcuts = new Shortcuts(this);
    this.stage.surface.addEventListener("keydown", (event) => {
      if (!this._shortcuts.press(event)) return;
      event.preventDefault();
      event.stopPropagation();
    });
    this.timeline = new Timeline(under, this);
    this.levelBar = new LevelBar(above, this);
  }

  release() {
    this._unwatch();
    this._arrival.disconnect();
    this.menus.close(false);
    for (const part of [this.pointer, this.notice, this.stage, this.timeline, this.levelBar]) {
      if (part && part.release) part.release();
    }
    this.link.onmessage = () => {};
    this.link.close();
    this.root.remove();
    delete this.root.meshwright;
  }

  // State

  get replica() {
    return this.stage.meshState.replica;
  }

  get derived() {
    return this.stage.meshState.derived;
  }

  get view() {
    return this.stage.view;
  }

  get readOnly() {
    return this.link.readOnly || this.replica.readOnly;
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
    return this.colours[name.replace(/-/g, "_")];
  }

  /** Call `callback` after every change of theme. */
  follow(callback) {
    this._followers.push(callback);
  }

  /** For tests and scripts: the point {x, y} of the page at a half-edge, just inside its element;
   * null if there is none. It may lie outside of the window or of the canvas.
   */
  screenOf(halfedge) {
    if (!this.replica.live(halfedge)) return null;
    const [x, y] = this.stage.middle(halfedge);
    const box = this.stage.surface.getBoundingClientRect();
    return { x: box.left + x, y: box.top + y };
  }

  // Messages

  /** Send a request to Python. */
  request(word, fields = {}) {
    if (this.readOnly && !["hello", "go_to", "level"].includes(word)) return;
    const id = this.link.send(word, fields);
    if (ANSWERED.includes(word)) {
      this._pending.push(id);
      if (this._pending.length === 1) this.notice.wait(true, this.replica.revision < 0);
    }
  }

  receive(content, buffers) {
    const mine = content.asked === undefined || content.asked === this.link.view;
    if (mine && Number.isInteger(content.reply)) this._answer(content.reply);
    const receivers = {
      state: () => this._onState(content, buffers),
      patch: () => this._onPatch(content, buffers),
      ghost: () => this.hoverState.receive(content, buffers),
      agent: () => this._onAgent(content),
      notice: () => this._onNotice(content),
      level: () => this.levelBar.update(content),
      blocks: () => this.blocks.receive(content, buffers),
      file: () => this.blocks.keep(content, buffers),
    };
    if (receivers[content.type]) receivers[content.type]();
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
      this._helloed = true; // a patch was missed: get the whole state, once
      this.request("hello");
    }
  }

  _onChanged() {
    const { head } = this.replica;
    this.score.update(head);
    this.colourChoice.update(head);
    this.names.update(head);
    this.timeline.update(head);
    this.blocks.update(head);
    this.root.setAttribute("aria-label", meshName(head));
    this.stage.surface.setAttribute("aria-label", canvasLabel(head));
    if (this.pointer.place && !this.hoverState.pinned && !this.menus.open) {
      this.hoverState.halfedge = this.pointer.halfedge();
    }
    this.hoverState.renew();
    this.menus.refresh();
  }

  _onAgent(content) {
    const busy = this.agentBusy;
    this.agent.update(content);
    this.root.dataset.agent = content.state;
    if (busy !== this.agentBusy) this.hoverState.renew();
  }

  _onNotice({ tone, sentence, reply }) {
    const stale = this.hoverState.refused(reply);
    if (!stale || tone === "failed") this.notify(tone, sentence);
  }

  /** Show a sentence; tone "refused", "info", "failed" or "hint". */
  notify(tone, sentence) {
    this.notice.show(tone, sentence);
  }

  /** Apply an operation at a half-edge, unless that was removed in the meantime. */
  operate(operation, halfedge) {
    const { replica } = this;
    if (!replica.live(halfedge)) return;
    const ends = [replica.origin[halfedge], replica.target(halfedge)];
    this.request("operate", { operation, halfedge, ends });
    const id = this._pending[this._pending.length - 1];
    this.hoverState.anticipate(() => this._pending.includes(id));
  }

  operateByKey(operation) {
    if (this.hoverState.halfedge < 0) this.notify("refused", "Point at a half-edge first, then press the key.");
    else this.operate(operation, this.hoverState.halfedge);
  }

  // Pointer

  pick(at, reach) {
    return this.stage.pick(at, reach);
  }

  hover(halfedge, at) {
    const badge = this.stage.overlay.badges.at(...at);
    const number = this.stage.overlay.blocks.at(...at);
    this.stage.surface.style.cursor = badge >= 0 || number >= 0 ? "pointer" : "";
    if (badge >= 0) this.showHint(badge);
    else if (!this.menus.open) {
      this.hoverState.preview(null);
      this.hoverState.point(halfedge);
    }
  }

  /** The mouse has left the canvas. */
  leave() {
    if (!this.menus.open && !this.hoverState.pinned) this.hoverState.point(-1);
  }

  /** Point at a half-edge by keyboard, menu or hint. */
  pin(halfedge) {
    this.hoverState.point(halfedge, true);
    this.hoverState.pinned = halfedge >= 0;
  }

  click(halfedge, at, touch) {
    this.zoomButtons.close();
    const badge = this.stage.overlay.badges.at(...at);
    if (badge >= 0) {
      this.agent.take(badge);
      return;
    }
    const number = this.stage.overlay.blocks.at(...at);
    if (number >= 0) {
      this.blocks.select(number, true);
      return;
    }
    this.hoverState.preview(null);
    this.hoverState.point(halfedge);
    if (halfedge < 0 || this.readOnly) return;
    if (this.hoverState.armed) this.operate(this.hoverState.armed, halfedge);
    else this.menus.openOperations(halfedge, at, touch);
  }

  doubleClick(halfedge) {
    if (halfedge >= 0 && this.hoverState.armed) return;
    this.menus.close();
    this.stage.fit();
  }

  cycle(step) {
    this.hoverState.cycle(step);
    this.announceSoon();
  }

  /** Show the changed hover state, and request what is missing. */
  pointed() {
    const { hoverState, replica, stage } = this;
    const info = replica.catalogue.find((one) => one.operation === hoverState.previewed);
    Object.assign(stage.shown, {
      halfedge: hoverState.halfedge, ghost: hoverState.ghost,
      title: info && !this.menus.open ? info.title : "", // an open menu shows it already
    });
    this.root.dataset.halfedge = hoverState.halfedge;
    this.root.dataset.meant = hoverState.previewed || "";
    this.operations.update();
    this.menus.refresh();
    const h = hoverState.halfedge;
    this.notice.where(h < 0 ? "" : placed(replica, hoverState));
    stage.repaint();
    hoverState.request();
  }

  // Hints

  showHints(hints) {
    Object.assign(this.stage.shown, { hints, selected: 0 });
    this.stage.repaint();
  }

  /** Bring a hint to the front, with its preview. */
  showHint(index) {
    const hint = this.agent.hints[index];
    this.stage.shown.selected = index;
    this.pin(hint.halfedge);
    this.hoverState.preview(hint.operation);
    this.stage.repaint();
  }

  // Sentences

  showWheelHint() {
    this.notify("hint", WHEEL_HINT);
  }

  /** After scrolling with one finger; shown a few times only. */
  showTouchHint() {
    this._touchHints += 1;
    if (this._touchHints <= MOST_TOUCH_HINTS) this.notify("hint", TOUCH_HINT);
  }

  /** Announce the half-edge to screen readers, after the last of several keys. */
  announceSoon(before = "") {
    this.notice.announce(() => before + described(this));
  }

  toggleHelp() {
    this.zoomButtons.toggle();
  }

  /** Close or cancel one thing: menu, help, armed operation, agent, half-edge. */
  escape() {
    if (this.menus.close()) return;
    if (this.zoomButtons.close()) this.focusCanvas();
    else if (this.hoverState.armed) this.hoverState.arm(this.hoverState.armed);
    else if (!this.agent.escape() && this.hoverState.pinned) this.hoverState.point(-1);
  }

  focusCanvas() {
    this.stage.surface.focus({ preventScroll: true });
  }

  _focusMoved(event) {
    const inside = event.relatedTarget && this.root.contains(event.relatedTarget);
    if (!inside && this.hoverState.pinned && !this.menus.open) this.hoverState.point(-1);
  }

  // Colours

  retheme() {
    const theme = this.wanted === "auto" ? hostTheme() : this.wanted;
    this.root.dataset.theme = theme;
    this._arrive();
  }

  /** Some hosts insert the card later; the colours can be read from then on. */
  _arrive() {
    if (this.root.isConnected && this.colours.theme !== this.root.dataset.theme) this.recolour();
  }

  /** Read the colours again; the card must be in the page. */
  recolour() {
    this.colours.read(this.root);
    this.stage.recolour();
    this.operations.update();
    for (const callback of this._followers) callback();
  }

  /** Set height and theme. */
  configure({ height, theme }) {
    this.stage.element.style.height = `${height}px`;
    this.wanted = theme;
    this.retheme();
  }

  _onPainted() {
    this._paints += 1;
    this.root.dataset.revision = this.replica.revision;
    this.root.dataset.painted = this._paints;
  }
}

/** Show a view of `link` in `element`; returns the Card. options: {height, theme}. */
export function mount(element, link, options = {}) {
  const card = new Card(link, options);
  element.append(card.root);
  card.retheme();
  return card;
}
