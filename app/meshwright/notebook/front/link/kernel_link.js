// The link to Python over the messages of an anywidget model.
//
// Every link has the same few members, whoever answers: send(word, fields) -> id of the message,
// onmessage(content, buffers) to be set by who listens, close(), readOnly.

let viewsSoFar = 0;

/** A name for one view of a model that no other has. */
export function viewName() {
  viewsSoFar += 1;
  const random = Math.floor(Math.random() * 0x7fffffff).toString(36);
  return `v${viewsSoFar}-${Date.now().toString(36)}-${random}`;
}

const LASTING_WORDS = ["agent", "level"]; // what they bring about goes on after the answer
const LOST = "The kernel that had this mesh is gone: run this cell again to go on.";

export class KernelLink {
  constructor(model) {
    this.readOnly = false;
    this.onmessage = () => {};
    this.view = viewName();
    this._model = model;
    this._last = 0;
    this._lasting = false; // something longer was asked for here, and is not over
    this._revision = this._counted = -1;
    this._receive = (content, buffers) => {
      // a patch is for all, and its "to" is a revision
      const mine = content && (content.type === "patch" || !content.to || content.to === this.view);
      if (!mine) return;
      this.onmessage(content, buffers || []);
      this._countChange(content);
    };
    model.on("msg:custom", this._receive);
  }

  /** Say something to Python; answers carry the id as `reply`. */
  send(word, fields = {}) {
    this._last += 1;
    if (LASTING_WORDS.includes(word) && !this._lasting) {
      this._lasting = true;
      this._counted = this._revision;
    }
    try {
      this._model.send({ do: word, id: this._last, view: this.view, ...fields });
    } catch (error) { // JupyterLab, once the kernel was restarted or shut down: "Cannot send"
      const reply = this._last;
      // later, as any answer: who asked must first know the number of its question
      setTimeout(() => this.onmessage({ type: "notice", tone: "failed", sentence: LOST, reply }, []));
    }
    return this._last;
  }

  /** In marimo: have the cells that use the widget run again, once what was asked for here is done.
   *
   * Not after what cells do themselves, or a cell that changes the mesh would run for ever.
   */
  _countChange({ type, asked, state, to, revision }) {
    if (type === "patch" || type === "state") this._revision = type === "patch" ? to : revision;
    const rests = type === "agent" && ["idle", "paused"].includes(state);
    const done = asked === this.view || (rests && this._lasting);
    if (!done || this._revision === this._counted) return;
    if (rests) this._lasting = false;
    this._counted = this._revision;
    if (!document.querySelector("marimo-anywidget")) return;
    this._model.set("seen", this._model.get("seen") + 1);
    this._model.save_changes();
  }

  close() {
    this._model.off("msg:custom", this._receive);
  }
}
