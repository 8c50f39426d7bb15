// The panel of the agent: policy, commands, progress, hints.

import { MOST_HINTS, percent } from "../canvas/hint_badges.js";
import { button, icon, node, setText } from "../dom.js";
import { counted, signed } from "../numbers.js";

const AGENT_SPEEDS = [0.5, 1, 2, 4, 6, 10, 15, 20, 30, 60];
const AGENT_AT_REST = ["idle", "paused"];
const PREFERENCES = ["blocks", "balanced", "shape"];
const PREFERRED = ["Few blocks", "Balanced", "Good shape"];

export class AgentPanel {
  constructor(card) {
    this.hints = [];
    this.state = "idle";
    this._card = card;
    this._policies = "";
    this._received = this._hidden = ""; // the hints received last, and those that were hidden
    this._make();
    this.root = node("section", "mw-part mw-part-agent", { "aria-label": "Agent", hidden: true },
      node("div", "mw-head-line", {}, node("h4", "mw-heading", {}, "Agent"), this._policy),
      node("div", "mw-buttons", {}, this._hint, this._step, this._play),
      node("div", "mw-buttons", {}, this._complete, this._stop,
        this._preferBox),
      this._sizeBox,
      node("div", "mw-agent-state", {}, this._words, this._skip),
      node("label", "mw-speed", {}, this._speed, this._pace),
      this._list);
  }

  /** Whether the agent is changing the mesh. */
  get busy() {
    return !AGENT_AT_REST.includes(this.state);
  }

  _make() {
    this._policy = node("select", "mw-select", { "aria-label": "Policy", title: "Policy for hints and runs" });
    this._policy.addEventListener("change", () => this._card.request("policy", { name: this._policy.value }));
    const action = (text, label, name, sign = null, look = "mw-button") =>
      button(look, label, { text, sign, act: () => this.request(name) });
    this._hint = action("Hint", "Show the policy's best few operations (H)", "hint");
    this._step = action("Step", "Apply one operation chosen by the policy (.)", "step", "step");
    this._play = button("mw-button", "Play", { text: "Play", sign: "play", act: () => this.toggle() });
    this._complete = action(
      "Complete", "Search until the optimum is reached or nothing more is won", "complete", null,
      "mw-button mw-primary",
    );
    this._skip = action("Skip", "Go to the result at once; its operations are in the history", "skip");
    this._skip.hidden = true;
    this._prefer = node("input", "mw-range", {
      type: "range", min: 0, max: 2, step: 1, value: 1, "aria-label": "Blocks or shape",
      title: "What searches aim at once s is at its optimum: few blocks, or corners as good as the outline permits",
    });
    this._preferred = node("span", "mw-pace", { "aria-hidden": "true" });
    this._preferBox = node("label", "mw-speed mw-prefer", {}, this._prefer, this._preferred);
    this._keepSize = node("input", "", { type: "checkbox" });
    this._sizeBox = node("label", "mw-check", {
      title: "Searches keep the size of the elements; otherwise they look for few, large blocks",
    }, this._keepSize, "Keep the size of the elements");
    this._prefer.addEventListener("input", () => this._updatePreference());
    this._updatePreference();
    this._stop = action("Stop", "Stop the policy; its operations are kept", "stop");
    this._speed = node("input", "mw-range", {
      type: "range", min: 0, max: AGENT_SPEEDS.length - 1, step: 1, value: 3, "aria-label": "Playing speed",
    });
    this._speed.addEventListener("input", () => {
      const value = AGENT_SPEEDS[this._speed.valueAsNumber];
      this._updatePace(value);
      this._card.request("speed", { value });
    });
    this._pace = node("span", "mw-pace", { "aria-hidden": "true" });
    this._words = node("p", "mw-hint mw-agent-words", { role: "status" });
    this._list = node("div", "mw-hints", { role: "group", "aria-label": "Hints", hidden: true });
  }

  /** Send a command to the agent. */
  request(action) {
    if (this._card.readOnly || this.root.hidden) return;
    if (action === "hint" && this.hints.length) {
      this._hideHints();
      return;
    }
    this._hidden = "";
    const prefer = PREFERENCES[this._prefer.valueAsNumber];
    this._card.request("agent", action === "complete" ? { action, prefer, keep_size: this._keepSize.checked } : { action });
  }

  /** Play or pause. */
  toggle() {
    this.request(this.state === "playing" ? "pause" : "play");
  }

  /** Apply the hint of this index; returns whether there is one. */
  take(index) {
    if (index >= this.hints.length) return false;
    this._card.request("take_hint", { index });
    return true;
  }

  /** Hide the hints, or stop the run; returns whether there was one of them. */
  escape() {
    if (this.hints.length) this._hideHints();
    else if (this.state !== "idle") this.request("stop");
    else return false;
    return true;
  }

  /** Show the content of an agent message. */
  update(content) {
    this.state = content.state;
    this.root.hidden = this._card.readOnly;
    this._updatePolicies(content);
    const playing = content.state === "playing";
    const words = playing ? "Pause" : content.state === "paused" ? "Resume" : "Play";
    this._play.replaceChildren(icon(playing ? "pause" : "play"), node("span", "", {}, words));
    this._play.setAttribute("aria-label", playing ? "Pause" : "Run the policy at this speed");
    this._play.title = playing ? "Pause the run (Space)" : "Run the policy at this speed (Space)";
    const none = !content.policies.length;
    for (const one of [this._hint, this._step, this._complete]) {
      one.disabled = none || content.loading || this.busy;
    }
    this._play.disabled = none || (this.busy && !playing);
    this._stop.hidden = content.state === "idle";
    this._complete.hidden = !this._stop.hidden;
    this._complete.lastChild.textContent = content.unfinished ? "Go on" : "Complete";
    this._skip.hidden = content.state !== "going";
    if (!this._speed.matches(":active")) {
      const away = AGENT_SPEEDS.map((speed) => Math.abs(speed - content.speed));
      this._speed.value = away.indexOf(Math.min(...away));
      this._updatePace(content.speed);
    }
    setText(this._words, this._statusText(content));
    const key = JSON.stringify(content.hints);
    this._setHints(key === this._hidden ? [] : content.hints);
    this._received = key;
  }

  /** Hide the hints until they change or are requested again. */
  _hideHints() {
    this._hidden = this._received;
    this._setHints([]);
  }

  _updatePreference() {
    const words = PREFERRED[this._prefer.valueAsNumber];
    setText(this._preferred, words);
    this._prefer.setAttribute("aria-valuetext", words);
  }

  _statusText({ loading, asking, state, progress, policies, outcome = "" }) {
    if (!policies.length) return "No policy for meshes of this kind.";
    const { decisions = 0, best = null, gap = null, shape = "", way = null, seconds = 0 } = progress || {};
    const lowest = best === null ? "" : `, best s ${best}`;
    if (loading) return "Loading the policy\u2026";
    if (asking) return "Computing hints\u2026";
    if (way) return `Going there: ${way[0].toLocaleString("en")} of ${way[1].toLocaleString("en")}`;
    if (state === "searching") {
      const above = gap > 0 ? `, ${gap} above the optimum` : "";
      const worst = shape ? `, ${shape}` : "";
      return `Searching: ${seconds.toFixed(0)} s${lowest}${above}${worst}`;
    }
    if (state === "playing") return `Playing: ${counted(decisions, "decision")}${lowest}`;
    if (state === "paused") return `Paused after ${counted(decisions, "decision")}${lowest}`;
    if (outcome) return outcome;
    return decisions ? `${counted(decisions, "decision")} taken${lowest}` : "Ready";
  }

  _updatePace(speed) {
    const words = `${speed.toLocaleString("en")} decisions per second`;
    setText(this._pace, `${speed.toLocaleString("en")}\u2009/\u2009s`);
    this._speed.setAttribute("aria-valuetext", words);
    this._speed.title = `Playing speed: ${words}`;
  }

  _updatePolicies({ policies, policy }) {
    const known = JSON.stringify(policies);
    if (known !== this._policies) {
      this._policies = known;
      const options = policies.map(({ name, label }) => node("option", "", { value: name }, label));
      if (!options.length) options.push(node("option", "", {}, "No policy"));
      this._policy.replaceChildren(...options);
      this._policy.disabled = !policies.length;
    }
    if (policies.length) this._policy.value = policy;
  }

  _setHints(hints) {
    const before = this.hints.length;
    this.hints = hints.slice(0, MOST_HINTS);
    this._list.hidden = !this.hints.length;
    const { colours } = this._card;
    this._list.replaceChildren(...this.hints.map((hint, index) => {
      const change = node("span", "mw-change", {}, signed(hint.change));
      change.style.color = colours.ofChange(hint.change);
      const chance = percent(hint.probability);
      const row = node("button", "mw-operation mw-hint-row", {
        type: "button", "aria-label": `Hint ${index + 1}: ${hint.title}, ${chance}, s ${signed(hint.change)}`,
        title: `Apply it (${index + 1})`,
      },
      node("kbd", "mw-key", {}, String(index + 1)), node("span", "mw-operation-title", {}, hint.next ? `${hint.title}, next step` : hint.title),
      node("span", "mw-chance", {}, chance), change);
      row.addEventListener("click", () => this.take(index));
      for (const type of ["pointerenter", "focus"]) {
        row.addEventListener(type, () => this._card.showHint(index));
      }
      return row;
    }));
    this._card.showHints(this.hints);
    const side = this.root.closest(".mw-side-scroll");
    if (side && this.hints.length && !before) side.scrollTop = side.scrollHeight;
  }
}
