// The score curve, painted.

import { trackNumber } from "../mesh/score_series.js";

/** Pixels between states above which every step has its own mark. */
const TRACK_APART = 7;

/** Paint the curve of `track` in `frame`. where: {shown, hovered}, states, -1 for none. */
export function paintTrack(pen, frame, track, card, where) {
  const last = track.length - 1;
  const bottom = frame.top + frame.height;
  pen.textBaseline = "middle";
  pen.lineJoin = "round";
  trackLevels(pen, frame, track, card);
  pen.setLineDash([4, 4]);
  trackLine(pen, frame.steps(track.optima, 0, last), card.colour("muted"), 1.2);
  pen.setLineDash([]);
  if (frame.broken) trackBreak(pen, frame, card.colour("muted"));
  const thin = frame.pace < 1;
  if (where.shown < last) trackLine(pen, frame.steps(track.scores, where.shown, last), card.colour("faint"), 1);
  trackLine(pen, frame.steps(track.scores, 0, where.shown), card.colour("accent"), thin ? 1 : 1.8);
  trackAuthors(pen, frame, track, card, where.shown);
  trackDiamond(pen, frame.x(track.best), frame.y(track.scores[track.best]), 5, card.colour("panel"), card.colour("accent"));
  if (where.hovered >= 0 && where.hovered <= last && where.hovered !== where.shown) {
    trackMark(pen, frame, track, where.hovered, card.colour("muted"), card.colour("panel"), 3, bottom);
  }
  trackMark(pen, frame, track, where.shown, card.colour("accent"), card.colour("panel"), 4.5, bottom);
}

/** The highest score and the optimum beside the curve. */
function trackLevels(pen, frame, track, card) {
  pen.textAlign = "right";
  pen.fillStyle = card.colour("muted");
  const goal = track.optima[track.optima.length - 1];
  const high = frame.y(frame.high);
  const low = frame.y(goal);
  pen.fillText(trackNumber(frame.high), frame.left - 10, high);
  if (low - high > 12) pen.fillText(trackNumber(goal), frame.left - 10, low);
  trackLine(pen, [[frame.left, high], [frame.left + frame.width, high]], card.colour("line"), 1);
}

function trackLine(pen, line, colour, width) {
  if (!line.length) return;
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.beginPath();
  line.forEach(([x, y], i) => (i ? pen.lineTo(x, y) : pen.moveTo(x, y)));
  pen.stroke();
}

/** Two slanted lines at the left edge: the optimum lies further below than it looks. */
function trackBreak(pen, frame, colour) {
  const y = frame.top + frame.height - 7;
  for (const shift of [-1.75, 1.75]) {
    trackLine(pen, [[frame.left - 4, y + shift + 2], [frame.left + 4, y + shift - 2]], colour, 1.2);
  }
}

/** Who took each step: below the curve a dot for a person, a small diamond for an agent.
 *
 * Where steps lie too close, runs of them: a bar for a person, two thin lines for an agent.
 */
function trackAuthors(pen, frame, track, card, shown) {
  const y = frame.top + frame.height + 12;
  const last = track.length - 1;
  const mine = card.colour("text");
  const theirs = card.colour("accent");
  if (frame.pace >= TRACK_APART) {
    for (let i = 1; i <= last; i += 1) {
      pen.globalAlpha = i > shown ? 0.4 : 1;
      if (track.mine(i)) trackDot(pen, frame.x(i), y, 2.2, mine);
      else trackDiamond(pen, frame.x(i), y, 3.2, card.colour("panel"), theirs);
    }
    pen.globalAlpha = 1;
    return;
  }
  for (let i = 1; i <= last;) {
    const begin = i;
    const person = track.mine(i);
    while (i <= last && track.mine(i) === person && (i <= shown) === (begin <= shown)) i += 1;
    const from = frame.x(begin - 1);
    const width = Math.max(frame.x(i - 1) - from, 1);
    pen.globalAlpha = begin > shown ? 0.4 : 1;
    pen.fillStyle = person ? mine : theirs;
    if (person) pen.fillRect(from, y - 2, width, 4);
    else [-2, 1].forEach((shift) => pen.fillRect(from, y + shift, width, 1));
  }
  pen.globalAlpha = 1;
}

function trackDot(pen, x, y, radius, colour) {
  pen.fillStyle = colour;
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
  pen.fill();
}

function trackDiamond(pen, x, y, reach, fill, line) {
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

function trackMark(pen, frame, track, state, colour, rim, radius, bottom) {
  const x = frame.x(state);
  trackLine(pen, [[x, frame.top - 6], [x, bottom + 4]], colour, 1);
  trackDot(pen, x, frame.y(track.scores[state]), radius + 1.5, rim);
  trackDot(pen, x, frame.y(track.scores[state]), radius, colour);
}
