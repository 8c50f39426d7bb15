// The link to Python through the messages of an anywidget model.
//
// All links have the same members: send(word, fields) -> id of the message, onmessage(content,
// buffers) to be set by the receiver, close(), readOnly.

let viewsSoFar = 0;

/** A unique name for one view of a model. */
export function viewName() {
  viewsSoFar += 1;
  const random = Math.floor(Math.random() * 0x7fffffff).toString(36);
  return `v${viewsSoFar}-${Date.now().toString(36)}-${random}`;
}

const LASTING_WORDS = ["agent", "level"]; // their effects continue after the answer
const LOST = "The kernel of this mesh has stopped: run this cell again to continue.";

export class KernelLink {
  constructor(model) {
    this.readOnly = false;
    this.onmessage = () => {};
    this.view = viewName();
    this._model = model;
    this._last = 0;
    this._lasting = false; // a lasting request from this view is in progress
    this._revision = this._counted = -1;
    this._receive = (content, buffers) => {
      // a patch is sent to all views, and its "to" is a revision
      const mine = content && (content.type === "patch" || !content.to || content.to === this.view);
      if (!mine) return;
      this.onmessage(content, buffers || []);
      this._countChange(content);
    };
    model.on("msg:custom", this._receive);
  }

  /** Send a request to Python; answers carry its id as `reply`. */
  send(word, fields = {}) {
    this._last += 1;
    if (LASTING_WORDS.includes(word) && !this._lasting) {
      this._lasting = true;
      this._counted = this._revision;
    }
    try {
      this._model.send({ do: word, id: this._last, view: this.view, ...fields });
    } catch (error) { // JupyterLab, after a restart or shutdown of the kernel: "Cannot send"
      const reply = this._last;
      // later, as any answer: the caller needs the id first
      setTimeout(() => this.onmessage({ type: "notice", tone: "failed", sentence: LOST, reply }, []));
    }
    return this._last;
  }

  /** In marimo: run the cells that use the widget again after a request of this view.
   *
   * Not after changes made by cells, or a cell that changes the mesh would run forever.
   */
  _countChange({ type, asked, state, to, revision }) {
    if (type === "patch" || type === "state") this._revision = type === "patch" ? to : revision;
    const idle = type === "agent" && ["idle", "paused"].includes(state);
    const done = asked === this.view || (idle && this._lasting);
    if (!done || this._revision === this._counted) return;
    if (idle) this._lasting = false;
    this._counted = this._revision;
    if (!document.querySelector("marimo-anywidget")) return;
    this._model.set("seen", this._model.get("seen") + 1);
    this._model.save_changes();
  }

  close() {
    this._model.off("msg:custom", this._receive);
  }
}
