// Score and optimum of every state of a history, and the polylines that show them.
//
// State 0 is the start, state i the one after step i; undone steps are included.

/** Multiple of the curve's span beyond which the axis is broken above the optimum. */
const FAR_FACTOR = 4;
const COLUMNS = ["scores", "optima", "titles", "by"];

export class ScoreSeries {
  constructor() {
    this.clear();
  }

  clear() {
    this.scores = [];
    this.optima = [];
    this.titles = [];
    this.by = [];
    this._best = -1;
    this._others = -1;
  }

  get length() {
    return this.scores.length;
  }

  /** Update from a head: states from `from` on are new, those beyond its length are removed. */
  follow(head) {
    const fresh = head.track;
    if (fresh) {
      const by = fresh.by || [];
      const begin = Math.min(fresh.from, this.length);
      for (const name of COLUMNS) this[name].length = begin;
      fresh.scores.forEach((score, i) => {
        this.scores.push(score);
        this.optima.push(fresh.optima[i]);
        this.titles.push(fresh.titles[i] || "");
        this.by.push(by[i] || "");
      });
    }
    for (const name of COLUMNS) this[name].length = Math.min(this[name].length, head.length + 1);
    this._best = -1;
    this._others = -1;
  }

  /** The earliest state with the lowest score of those that share the last state's optimum. */
  get best() {
    if (this._best >= 0) return this._best;
    const last = this.length - 1;
    let best = last;
    for (let i = last; i >= 0 && this.optima[i] === this.optima[last]; i -= 1) {
      if (this.scores[i] <= this.scores[best]) best = i;
    }
    this._best = Math.max(best, 0);
    return this._best;
  }

  /** "Flip left by quad-paper": the step before a state. */
  words(state) {
    if (state <= 0) return "the start";
    return `${this.titles[state] || "a step"}${this.by[state] ? ` by ${this.by[state]}` : ""}`;
  }

  /** " (−2)": its change of the score; empty for the start. */
  change(state) {
    return state <= 0 ? "" : ` (${formatChange(this.scores[state] - this.scores[state - 1])})`;
  }

  /** Number of steps by agents. */
  get others() {
    if (this._others < 0) this._others = this.by.reduce((sum, _, i) => sum + (i > 0 && !this.mine(i)), 0);
    return this._others;
  }

  /** Whether the step before a state is the user's. */
  mine(state) {
    return this.by[state] === "" || this.by[state] === "you";
  }
}

/** "+1", "−2" with a true minus sign, "±0". */
function formatChange(change) {
  if (change === 0) return "±0";
  return change > 0 ? `+${change}` : `−${-change}`;
}

/** "12,345". */
export function formatNumber(value) {
  return value.toLocaleString("en-US");
}

/** Maps states and scores to pixels.
 *
 * The axis is `broken` where the optimum lies so far below all scores that the curve would look flat;
 * then the optimum is drawn at the lower edge.
 */
export class CurveFrame {
  constructor(series, left, top, width, height) {
    this.left = left;
    this.top = top;
    this.width = Math.max(width, 1);
    this.height = height;
    this.last = Math.max(series.length - 1, 1);
    let goal = Infinity;
    let lowest = Infinity;
    let high = -Infinity;
    for (let i = 0; i < series.length; i += 1) {
      goal = Math.min(goal, series.optima[i]);
      lowest = Math.min(lowest, series.scores[i]);
      high = Math.max(high, series.scores[i]);
    }
    this.high = Math.max(high, goal + 1);
    const room = Math.max(this.high - lowest, 4);
    this.broken = lowest - goal > FAR_FACTOR * room;
    this.low = this.broken ? lowest - 0.5 * room : goal;
  }

  x(state) {
    return this.left + (state * this.width) / this.last;
  }

  y(score) {
    return this.top + this.height * (1 - Math.max(score - this.low, 0) / (this.high - this.low));
  }

  state(x) {
    const nearest = Math.round(((x - this.left) / this.width) * this.last);
    return Math.min(Math.max(nearest, 0), this.last);
  }

  /** Pixels from one state to the next. */
  get pace() {
    return this.width / this.last;
  }

  /** Values from state `first` to `last` as a step curve [[x, y], ...].
   *
   * With more states than pixels, each column of pixels shows the minimum and the maximum in it, so
   * that the size depends on the width and not on the history.
   */
  steps(values, first, last) {
    const line = [];
    if (this.pace >= 0.5) {
      for (let i = first; i <= last; i += 1) {
        if (i > first && values[i] === values[i - 1] && i < last) continue;
        if (i > first) line.push([this.x(i), this.y(values[i - 1])]);
        line.push([this.x(i), this.y(values[i])]);
      }
      return line;
    }
    for (let i = first; i <= last;) {
      const column = Math.floor(this.x(i));
      let low = values[i];
      let high = values[i];
      const begin = i;
      for (; i <= last && Math.floor(this.x(i)) === column; i += 1) {
        low = Math.min(low, values[i]);
        high = Math.max(high, values[i]);
      }
      const rising = values[i - 1] >= values[begin];
      line.push([column + 0.5, this.y(rising ? low : high)], [column + 0.5, this.y(rising ? high : low)]);
    }
    return line;
  }
}
