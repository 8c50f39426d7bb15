// Hints on the mesh: an arrow along each half-edge, and a numbered badge that can be clicked.

import { clamp, signed } from "../numbers.js";
import { arrowMiddle, arrowOf, paintArrow } from "./arrow.js";

const BADGE_HEIGHT = 22;
const BADGE_GAP = 4;
export const MOST_HINTS = 5;
const BADGE_TRIES = [[1, -1], [-1, -1], [1, 1], [-1, 1], [1, 0], [-1, 0], [0, -1], [0, 1]];

/** "63 %"; very small ones are "< 1 %". */
export function percent(probability) {
  return probability < 0.01 ? "< 1\u2009%" : `${Math.round(100 * probability)}\u2009%`;
}

export class HintBadges {
  constructor(colours) {
    this._colours = colours;
    this._boxes = [];
  }

  /** Remove all badges. */
  clear() {
    this._boxes = [];
  }

  /** The index of the hint whose badge lies at (x, y), -1 for none. */
  at(x, y) {
    return this._boxes.findIndex((box) => box && x >= box.x && x <= box.x + box.width
      && y >= box.y && y <= box.y + BADGE_HEIGHT);
  }

  /** Points [x, y] covered by the badges, which labels avoid. */
  get places() {
    const shares = [0, 0.25, 0.5, 0.75, 1];
    return this._boxes.flatMap((box) => (box
      ? shares.map((share) => [box.x + share * box.width, box.y + BADGE_HEIGHT / 2]) : []));
  }

  /** Paint all hints, the selected one in front. `marks`: points that badges avoid. */
  paint(pen, view, replica, hints, selected, marks) {
    const colours = this._colours;
    pen.font = `600 12px ${colours.font}`;
    this._boxes = [];
    const roots = hints.slice(0, MOST_HINTS).map((hint) => {
      if (!replica.live(hint.halfedge)) return null;
      const points = arrowOf(replica, view, hint.halfedge);
      return { points, middle: arrowMiddle(points) };
    });
    roots.forEach((root, i) => {
      if (!root) return;
      pen.globalAlpha = i === selected ? 1 : 0.6;
      paintArrow(pen, root.points, colours.accent, colours.background);
    });
    pen.globalAlpha = 1;
    roots.forEach((root, i) => this._boxes.push(root && this._place(pen, view, root, hints[i], marks)));
    const order = roots.map((_, i) => i).filter((i) => this._boxes[i]);
    order.sort((a, b) => (a === selected) - (b === selected));
    for (const i of order) this._paintBadge(pen, this._boxes[i], i + 1, hints[i], i === selected);
  }

  /** The place around a root with the least overlap. */
  _place(pen, view, { middle }, hint, marks) {
    const [x, y] = middle;
    if (x < 0 || y < 0 || x > view.width || y > view.height) return null;
    const words = pen.measureText(`${percent(hint.probability)}   ${signed(hint.change)}`).width;
    const width = BADGE_HEIGHT + words + 14;
    let best = null;
    let least = Infinity;
    for (const ring of [1, 1.7, 2.6]) {
      for (const [dx, dy] of BADGE_TRIES) {
        const shift = dx > 0 ? 0 : dx < 0 ? -width : -width / 2;
        const left = clamp(x + 16 * dx * ring + shift, BADGE_GAP, view.width - width - BADGE_GAP);
        const top = clamp(
          y + 26 * dy * ring - BADGE_HEIGHT / 2, BADGE_GAP, view.height - BADGE_HEIGHT - BADGE_GAP,
        );
        const clashes = this._boxes.filter((box) => box && box.x < left + width + BADGE_GAP
          && box.x + box.width + BADGE_GAP > left && box.y < top + BADGE_HEIGHT + BADGE_GAP
          && box.y + BADGE_HEIGHT + BADGE_GAP > top).length;
        const covered = marks.filter(([px, py]) => px > left - 8 && px < left + width + 8
          && py > top - 8 && py < top + BADGE_HEIGHT + 8).length;
        const cost = 100 * clashes + 4 * covered + 2 * ring;
        if (cost < least) [best, least] = [{ x: left, y: top, width, root: middle }, cost];
      }
    }
    return best;
  }

  _paintBadge(pen, box, number, hint, selected) {
    const colours = this._colours;
    pen.strokeStyle = colours.accent;
    pen.lineWidth = 1.25;
    pen.beginPath();
    pen.moveTo(...box.root);
    pen.lineTo(box.x + box.width / 2, box.y + BADGE_HEIGHT / 2);
    pen.stroke();
    pen.fillStyle = colours.raised;
    pen.strokeStyle = selected ? colours.accent : colours.line;
    pen.lineWidth = selected ? 1.5 : 1;
    pen.beginPath();
    pen.roundRect(box.x, box.y, box.width, BADGE_HEIGHT, BADGE_HEIGHT / 2);
    pen.fill();
    pen.stroke();
    const middle = box.y + BADGE_HEIGHT / 2;
    pen.fillStyle = selected ? colours.accent : colours.accent_soft;
    pen.beginPath();
    pen.arc(box.x + BADGE_HEIGHT / 2, middle, BADGE_HEIGHT / 2 - 2, 0, 2 * Math.PI);
    pen.fill();
    pen.textBaseline = "middle";
    pen.textAlign = "center";
    pen.fillStyle = selected ? colours.accent_text : colours.accent;
    pen.fillText(String(number), box.x + BADGE_HEIGHT / 2, middle + 0.5);
    pen.textAlign = "left";
    pen.fillStyle = colours.text;
    pen.fillText(percent(hint.probability), box.x + BADGE_HEIGHT + 2, middle + 0.5);
    pen.textAlign = "right";
    pen.fillStyle = colours.ofChange(hint.change);
    pen.fillText(signed(hint.change), box.x + box.width - 9, middle + 0.5);
  }
}
