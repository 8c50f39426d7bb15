// Keyboard shortcuts of the canvas.

export const KEY_HELP = [
  ["\u2190 \u2192", "Previous and next half-edge"],
  ["\u2191", "Other side of the edge"],
  ["\u2193", "Next irregular vertex"],
  ["Return", "Apply the previewed operation"],
  ["[ ]", "Preview another operation"],
  ["M", "Menu of the half-edge"],
  ["U", "Undo; with Shift redo"],
  ["+ \u2212 0", "Zoom in, zoom out, fit"],
  ["H", "Hints; then 1 to 5 applies one"],
  [".", "One step of the agent"],
  ["Space", "Play or pause the agent"],
  ["Esc", "Close, cancel, stop"],
];
export const MOUSE_HELP = [
  ["Click", "Operations of a half-edge"],
  ["Right click", "Desired degree, corner, lock"],
  ["Drag", "Pan"],
  ["Ctrl + wheel", "Zoom"],
  ["Double click", "Fit the mesh"],
];

export class Shortcuts {
  constructor(card) {
    this._card = card;
    const navigation = card.navigation;
    this._actions = {
      ArrowRight: () => navigation.along(1),
      ArrowLeft: () => navigation.along(-1),
      ArrowUp: () => navigation.across(),
      ArrowDown: (event) => navigation.toIrregular(event.shiftKey ? -1 : 1),
      Enter: () => card.hoverState.act(),
      "[": () => card.cycle(-1),
      "]": () => card.cycle(1),
      m: () => card.menus.openByKey(),
      ContextMenu: () => card.menus.openByKey(),
      u: () => card.request("undo"),
      U: () => card.request("redo"),
      "+": () => card.stage.zoom(1.25),
      "=": () => card.stage.zoom(1.25),
      "-": () => card.stage.zoom(0.8),
      0: () => card.stage.fit(),
      h: () => card.agent.request("hint"),
      ".": () => card.agent.request("step"),
      " ": () => card.agent.toggle(),
      "?": () => card.toggleHelp(),
      Escape: () => card.escape(),
    };
  }

  /** Handle a key event on the canvas; returns whether the key is a shortcut. */
  press(event) {
    if (event.altKey) return false;
    if (event.ctrlKey || event.metaKey) return this._pressWithControl(event);
    const key = event.key.length === 1 && event.key !== "U" ? event.key.toLowerCase() : event.key;
    if (event.key === "F10" && event.shiftKey) {
      this._card.menus.openByKey();
      return true;
    }
    const info = this._card.replica.catalogue.find((one) => one.key.toLowerCase() === key);
    if (info) this._card.operateByKey(info.operation);
    else if (/^[1-9]$/.test(key)) return this._card.agent.take(Number(key) - 1);
    else if (this._actions[key]) this._actions[key](event);
    else return false;
    return true;
  }

  _pressWithControl(event) {
    const key = event.key.toLowerCase();
    if (key === "z") this._card.request(event.shiftKey ? "redo" : "undo");
    else if (key === "y") this._card.request("redo");
    else return false;
    return true;
  }
}
