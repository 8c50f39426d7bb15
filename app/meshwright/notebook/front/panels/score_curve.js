// Paints the score curve.

import { formatNumber } from "../mesh/score_series.js";

/** Pixels between states above which every step gets its own mark. */
const APART = 7;

/** Paint the curve of `series` in `frame`. where: {shown, hovered}, states, -1 for none. */
export function paintScoreCurve(pen, frame, series, card, where) {
  const last = series.length - 1;
  const bottom = frame.top + frame.height;
  pen.textBaseline = "middle";
  pen.lineJoin = "round";
  paintLevels(pen, frame, series, card);
  pen.setLineDash([4, 4]);
  strokeLine(pen, frame.steps(series.optima, 0, last), card.colour("muted"), 1.2);
  pen.setLineDash([]);
  if (frame.broken) paintBreak(pen, frame, card.colour("muted"));
  const thin = frame.pace < 1;
  if (where.shown < last) strokeLine(pen, frame.steps(series.scores, where.shown, last), card.colour("faint"), 1);
  strokeLine(pen, frame.steps(series.scores, 0, where.shown), card.colour("accent"), thin ? 1 : 1.8);
  paintAuthors(pen, frame, series, card, where.shown);
  paintDiamond(pen, frame.x(series.best), frame.y(series.scores[series.best]), 5, card.colour("panel"), card.colour("accent"));
  if (where.hovered >= 0 && where.hovered <= last && where.hovered !== where.shown) {
    paintMark(pen, frame, series, where.hovered, card.colour("muted"), card.colour("panel"), 3, bottom);
  }
  paintMark(pen, frame, series, where.shown, card.colour("accent"), card.colour("panel"), 4.5, bottom);
}

/** The highest score and the optimum beside the curve. */
function paintLevels(pen, frame, series, card) {
  pen.textAlign = "right";
  pen.fillStyle = card.colour("muted");
  const goal = series.optima[series.optima.length - 1];
  const high = frame.y(frame.high);
  const low = frame.y(goal);
  pen.fillText(formatNumber(frame.high), frame.left - 10, high);
  if (low - high > 12) pen.fillText(formatNumber(goal), frame.left - 10, low);
  strokeLine(pen, [[frame.left, high], [frame.left + frame.width, high]], card.colour("line"), 1);
}

function strokeLine(pen, line, colour, width) {
  if (!line.length) return;
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.beginPath();
  line.forEach(([x, y], i) => (i ? pen.lineTo(x, y) : pen.moveTo(x, y)));
  pen.stroke();
}

/** Two slanted lines at the left edge: the axis is broken above the optimum. */
function paintBreak(pen, frame, colour) {
  const y = frame.top + frame.height - 7;
  for (const shift of [-1.75, 1.75]) {
    strokeLine(pen, [[frame.left - 4, y + shift + 2], [frame.left + 4, y + shift - 2]], colour, 1.2);
  }
}

/** The author of each step, below the curve: a dot for the user, a diamond for an agent.
 *
 * Where steps are too close, runs of steps: a bar for the user, two thin lines for an agent.
 */
function paintAuthors(pen, frame, series, card, shown) {
  const y = frame.top + frame.height + 12;
  const last = series.length - 1;
  const mine = card.colour("text");
  const theirs = card.colour("accent");
  if (frame.pace >= APART) {
    for (let i = 1; i <= last; i += 1) {
      pen.globalAlpha = i > shown ? 0.4 : 1;
      if (series.mine(i)) paintDot(pen, frame.x(i), y, 2.2, mine);
      else paintDiamond(pen, frame.x(i), y, 3.2, card.colour("panel"), theirs);
    }
    pen.globalAlpha = 1;
    return;
  }
  for (let i = 1; i <= last;) {
    const begin = i;
    const person = series.mine(i);
    while (i <= last && series.mine(i) === person && (i <= shown) === (begin <= shown)) i += 1;
    const from = frame.x(begin - 1);
    const width = Math.max(frame.x(i - 1) - from, 1);
    pen.globalAlpha = begin > shown ? 0.4 : 1;
    pen.fillStyle = person ? mine : theirs;
    if (person) pen.fillRect(from, y - 2, width, 4);
    else [-2, 1].forEach((shift) => pen.fillRect(from, y + shift, width, 1));
  }
  pen.globalAlpha = 1;
}

function paintDot(pen, x, y, radius, colour) {
  pen.fillStyle = colour;
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
  pen.fill();
}

function paintDiamond(pen, x, y, reach, fill, line) {
  pen.beginPath();
  pen.moveTo(x, y - reach);
  pen.lineTo(x + reach, y);
  pen.lineTo(x, y + reach);
  pen.lineTo(x - reach, y);
  pen.closePath();
  pen.fillStyle = fill;
  pen.fill();
  pen.strokeStyle = line;
  pen.lineWidth = 1.4;
  pen.stroke();
}

function paintMark(pen, frame, series, state, colour, rim, radius, bottom) {
  const x = frame.x(state);
  strokeLine(pen, [[x, frame.top - 6], [x, bottom + 4]], colour, 1);
  paintDot(pen, x, frame.y(series.scores[state]), radius + 1.5, rim);
  paintDot(pen, x, frame.y(series.scores[state]), radius, colour);
}
