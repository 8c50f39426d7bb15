// Paints block edges in the colours of their chords, with the numbers of cells on them.

const ROOM = 26;
const HEIGHT = 16;

export class BlocksLayer {
  constructor(colours) {
    this._colours = colours;
    this._cards = [];
  }

  /** Forget the places of the numbers. */
  clear() {
    this._cards = [];
  }

  /** The edge whose number is at (x, y); -1 for none. */
  at(x, y) {
    const hit = this._cards.find((card) => x >= card.x && y >= card.y
      && x <= card.x + card.width && y <= card.y + HEIGHT);
    return hit ? hit.edge : -1;
  }

  /** Paint {lines, chord, counts, set, wrong, colours}; edges of the chord `selected` are stronger. */
  paint(pen, view, blocks, selected) {
    const colours = blocks.colours[this._colours.theme] || blocks.colours.light;
    const lines = blocks.lines.map((line) => this._onScreen(view, line));
    pen.lineCap = "round";
    for (const strong of [false, true]) {
      lines.forEach((line, edge) => {
        const chord = blocks.chord[edge];
        if ((chord === selected) !== strong) return;
        if (blocks.wrong.includes(chord)) this._stroke(pen, line, this._colours.warning, 8);
        if (strong) this._stroke(pen, line, this._colours.raised, 7);
        this._stroke(pen, line, colours[chord], strong ? 4 : 2.4);
      });
    }
    pen.lineCap = "butt";
    this._cards = [];
    if (!blocks.counts) return;
    pen.font = `600 11px ${this._colours.font}`;
    lines.forEach((line, edge) => this._paintNumber(pen, view, line, edge, blocks, colours));
  }

  _onScreen(view, line) {
    const places = [];
    for (let i = 0; i < line.length; i += 2) places.push(view.toScreen(line[i], line[i + 1]));
    return places;
  }

  _stroke(pen, line, colour, width) {
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.beginPath();
    line.forEach(([x, y], i) => (i ? pen.lineTo(x, y) : pen.moveTo(x, y)));
    pen.stroke();
  }

  /** A card in the middle of the edge: filled where the number was set by hand. */
  _paintNumber(pen, view, line, edge, blocks, colours) {
    const steps = line.slice(1).map(([x, y], i) => Math.hypot(x - line[i][0], y - line[i][1]));
    const length = steps.reduce((sum, step) => sum + step, 0);
    if (length < ROOM) return;
    let left = length / 2;
    const i = Math.max(0, steps.findIndex((step) => (left -= step) <= 0));
    const share = steps[i] ? 1 + left / steps[i] : 0;
    const [a, b] = [line[i], line[i + 1]];
    const [x, y] = [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
    const chord = blocks.chord[edge];
    const text = String(blocks.counts[chord]);
    const width = Math.max(pen.measureText(text).width + 10, HEIGHT);
    const card = { edge, x: x - width / 2, y: y - HEIGHT / 2, width };
    const seen = x > 0 && y > 0 && x < view.width && y < view.height;
    const taken = this._cards.some((other) => other.x < card.x + width && card.x < other.x + other.width
      && other.y < card.y + HEIGHT && card.y < other.y + HEIGHT);
    if (!seen || taken) return;
    this._cards.push(card);
    const set = blocks.set.includes(chord);
    const colour = blocks.wrong.includes(chord) ? this._colours.warning : colours[chord];
    pen.fillStyle = set ? colour : this._colours.raised;
    pen.strokeStyle = colour;
    pen.lineWidth = 1.4;
    pen.beginPath();
    pen.roundRect(card.x, card.y, width, HEIGHT, 5);
    pen.fill();
    pen.stroke();
    pen.fillStyle = set ? this._colours.background : this._colours.text;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillText(text, x, y + 0.5);
  }
}
