// The bar above the canvas while a level is played: goal, par, operations used, stars, and the
// agent's solution.

import { drawn, node, setText } from "../dom.js";

const STARS = 3;
const STAR_PATH = starPath(10, 10, 8.5, 3.9);

export class LevelBar {
  constructor(place, card) {
    this._card = card;
    this._all = [];
    this._done = false;
    this._waits = false;
    this._choice = node("select", "mw-select mw-level-choice", { "aria-label": "Choose a level" });
    this._choice.addEventListener("change", () => this._request("open", this._choice.value));
    this._stars = starRow("mw-level-stars");
    this._facts = node("div", "mw-level-facts");
    this._text = node("p", "mw-level-text");
    this._again = this._button("Restart", "again", "Restart this level");
    this._solve = this._button("Ask the agent", "solve", "");
    this._next = this._button("Next", "next", "Go to the next level");
    this._live = node("div", "mw-unseen", { role: "status", "aria-live": "polite" });
    place.append(
      node("div", "mw-level-line", {}, this._choice, this._stars, this._facts),
      node("div", "mw-level-line", {}, this._text,
        node("div", "mw-level-buttons", {}, this._again, this._solve, this._next)),
      this._live,
    );
    this._place = place;
    place.setAttribute("role", "region");
    place.setAttribute("aria-label", "Level");
    place.hidden = true;
  }

  /** Show the content of a level message. */
  update({ level, all }) {
    this._place.hidden = level === null;
    if (all) this._all = all;
    if (level === null) return;
    this._waits = false;
    this._fill(level);
    showStars(this._stars, level.done ? level.stars : level.best_stars);
    this._stars.title = level.done ? "Earned in this attempt" : "Your best so far";
    this._updateFacts(level);
    this._updateText(level);
    this._updateButtons(level);
    this._animateStars(level);
  }

  _button(title, action, label) {
    const made = node("button", "mw-button", { type: "button", title: label }, node("span", "", {}, title));
    made.addEventListener("click", () => this._request(action));
    return made;
  }

  _request(action, name = null) {
    if (this._waits || this._card.readOnly) return;
    this._waits = true; // ignore a second click before the answer
    setTimeout(() => { this._waits = false; }, 400);
    this._card.request("level", name === null ? { action } : { action, name });
  }

  /** Fill the list of levels. */
  _fill(level) {
    const rows = this._all.map((one, index) => {
      const won = one.stars ? `  ${"\u2605".repeat(one.stars)}` : "";
      return [one.name, `${index + 1}  ${one.title}${won}`];
    });
    const key = JSON.stringify(rows);
    if (key !== this._listed) {
      this._listed = key;
      this._choice.replaceChildren(...rows.map(([name, words]) => node("option", "", { value: name }, words)));
    }
    this._choice.value = level.name;
    this._choice.disabled = this._card.readOnly;
  }

  _updateFacts(level) {
    const { rival } = level;
    const facts = [
      ["Goal", level.aim, "The score to reach: the lowest possible"],
      ["Par", level.par, level.proved
        ? "The minimum number of operations, proved by exhaustive search"
        : "The fewest operations known; fewer may be possible"],
      ["You", level.used, "Operations applied since the start; undo reduces the number"],
    ];
    if (rival) facts.push(["Agent", answerOf(rival), "Operations of the agent, on its own copy of the mesh"]);
    const key = JSON.stringify(facts);
    if (key === this._factsKey) return;
    this._factsKey = key;
    this._facts.replaceChildren(...facts.map(([name, value, label]) =>
      node("span", "mw-level-fact", { title: label }, `${name} `, node("b", "", {}, String(value)))));
  }

  _updateText(level) {
    const { headline, remark, rival } = level;
    const failed = rival && rival.standing === "failed" ? rival.reason : "";
    this._text.dataset.tone = level.done && !level.helped ? "won" : remark || failed ? "warns" : "";
    const words = remark || failed || level.text;
    this._text.replaceChildren(...(headline ? [node("b", "", {}, `${headline}. `)] : []), words);
    setText(this._live, headline || remark ? `${headline} ${remark}` : "");
  }

  _updateButtons(level) {
    const searching = level.rival !== null && level.rival.standing === "asked";
    setText(this._solve.firstChild, level.answered ? "Show a solution" : searching ? "Searching\u2026" : "Ask the agent");
    this._solve.title = level.answered
      ? "Restart with the agent's operations in the history: redo applies them"
      : "Let the agent solve this level on its own copy of the mesh";
    const reads = this._card.readOnly;
    this._solve.disabled = searching || reads;
    this._again.disabled = reads;
    this._next.disabled = level.next === null || reads;
    this._next.classList.toggle("mw-primary", level.done && level.stars > 0 && level.next !== null);
  }

  /** Light up the stars one after the other; at once with reduced motion. */
  _animateStars(level) {
    const won = level.done && level.stars > 0;
    this._place.toggleAttribute("data-won", won);
    if (won && !this._done) {
      this._stars.classList.remove("mw-fresh");
      void this._stars.offsetWidth; // restarts the animation
      this._stars.classList.add("mw-fresh");
    }
    if (!won) this._stars.classList.remove("mw-fresh");
    this._done = won;
  }
}

/** The agent's result in short. */
function answerOf(rival) {
  if (rival.standing === "asked") return "\u2026";
  if (rival.standing === "failed") return "\u2013";
  return rival.reached ? rival.used : `${rival.used} (s ${rival.score})`;
}

/** Three stars. */
function starRow(name) {
  const row = node("span", name, { role: "img" });
  for (let i = 0; i < STARS; i += 1) row.append(drawn(STAR_PATH, { class: "mw-star" }));
  return row;
}

/** Fill the first `count` stars of a row. */
function showStars(row, count) {
  row.setAttribute("aria-label", `${count} of ${STARS} stars`);
  [...row.children].forEach((star, index) => star.toggleAttribute("data-won", index < count));
}

/** A star with five tips around (x, y), as a path. */
function starPath(x, y, outer, inner) {
  const corners = [];
  for (let i = 0; i < 10; i += 1) {
    const angle = Math.PI * (i / 5 - 0.5);
    const reach = i % 2 ? inner : outer;
    corners.push(`${(x + reach * Math.cos(angle)).toFixed(2)} ${(y + reach * Math.sin(angle)).toFixed(2)}`);
  }
  return `M${corners.join("L")}Z`;
}
