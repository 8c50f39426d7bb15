// One view: a card with a canvas, a panel and a timeline, that follows a link.
//
// Places for the other parts, which are made where their classes exist:
//   new Timeline(element, card)   under the canvas; .update(head) with every state and patch
//   new Levels(element, card)     above the panel; .update(message) with every "level" message
// Both may have .release(). What a part may use of the card: card.link.send(word, fields),
// card.mirror, card.colour("accent"), card.say(tone, sentence), card.root, and card.follow(callback),
// which calls back after every change of theme or size.
//
// For tests and scripts: the card element carries data-revision (of the mesh that is painted) and
// data-painted (how often it has been), and `element.meshwright` is the Card.

class Card {
  constructor(link, options) {
    this.link = link;
    this.mirror = new Mirror();
    this.wanted = options.theme || "auto";
    this._followers = [];
    this._ends = [];
    this._painted = 0;
    this._make(options);
    link.onmessage = (content, buffers) => this.receive(content, buffers);
    this._ends.push(watchHost(() => this.retheme()));
    const observer = new ResizeObserver(() => this.resized());
    observer.observe(this.stage);
    this._ends.push(() => observer.disconnect());
    this.retheme();
    link.send("hello");
  }

  _make(options) {
    this.root = document.createElement("div");
    this.root.className = "meshwright";
    this.root.meshwright = this;
    this.root.setAttribute("data-lm-suppress-shortcuts", "true");
    const part = (name, parent) => {
      const made = document.createElement("div");
      made.className = `mw-${name}`;
      parent.append(made);
      return made;
    };
    this.main = part("main", this.root);
    this.stage = part("stage", this.main);
    this.stage.style.height = `${options.height || 480}px`;
    this.canvas = document.createElement("canvas");
    this.stage.append(this.canvas);
    const under = part("timeline", this.main);
    const side = part("side", this.root);
    const above = part("levels", side);
    this.panel = part("panel", side);
    this.timeline = typeof Timeline === "function" ? new Timeline(under, this) : null;
    this.levels = typeof Levels === "function" ? new Levels(above, this) : null;
  }

  // What the parts use

  colour(name) {
    return getComputedStyle(this.root).getPropertyValue(`--mw-${name}`).trim();
  }

  say(tone, sentence) {
    this.panel.dataset.notice = sentence;
  }

  follow(callback) {
    this._followers.push(callback);
  }

  // Following

  retheme() {
    this.root.dataset.theme = this.wanted === "auto" ? hostTheme() : this.wanted;
    this.resized();
  }

  resized() {
    this.paint();
    for (const callback of this._followers) callback();
  }

  receive(content, buffers) {
    if (content.say === "state") {
      this.mirror.loadState(content, buffers);
    } else if (content.say === "patch") {
      if (!this.mirror.applyPatch(content, buffers)) {
        this.link.send("hello");
        return;
      }
    } else if (content.say === "level" && this.levels) {
      this.levels.update(content);
    }
    if (content.say === "state" || content.say === "patch") {
      if (this.timeline) this.timeline.update(content.head);
      this.paint();
    }
  }

  paint() {
    const { mirror, canvas, stage } = this;
    const ratio = devicePixelRatio || 1;
    canvas.width = stage.clientWidth * ratio;
    canvas.height = stage.clientHeight * ratio;
    const bounds = mirror.bounds();
    if (!bounds) return;
    const pen = canvas.getContext("2d");
    const size = Math.min(canvas.width, canvas.height);
    const at = (v) => [
      canvas.width / 2 + 0.45 * size * mirror.places[2 * v],
      canvas.height / 2 - 0.45 * size * mirror.places[2 * v + 1],
    ];
    pen.strokeStyle = this.colour("edge");
    pen.beginPath();
    for (let h = 0; h < mirror.halfedges; h += 1) {
      if (!mirror.live(h) || mirror.twin[h] > h) continue;
      pen.moveTo(...at(mirror.origin[h]));
      pen.lineTo(...at(mirror.target(h)));
    }
    pen.stroke();
    this._painted += 1;
    this.root.dataset.revision = mirror.revision;
    this.root.dataset.painted = this._painted;
  }

  release() {
    for (const end of this._ends.splice(0)) end();
    if (this.timeline && this.timeline.release) this.timeline.release();
    if (this.levels && this.levels.release) this.levels.release();
    this.link.close();
    this.root.remove();
  }
}

/** Show what `link` tells in `element`; returns the Card. options: {height, theme}. */
function mount(element, link, options = {}) {
  const card = new Card(link, options);
  element.append(card.root);
  return card;
}

/** What anywidget calls for every view. */
function render({ model, el }) {
  const link = new KernelLink(model);
  const card = mount(el, link, { height: model.get("height"), theme: model.get("theme") });
  return () => card.release();
}
