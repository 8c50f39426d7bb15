// The link of a view whose kernel may not run: a snapshot of the mesh until the kernel answers.
//
// A saved notebook keeps the snapshot in the state of its widgets. If no state has come from Python
// after DELAY, the snapshot is shown as a read-only recording; the first state from Python ends
// that.

import { RecordingLink } from "./recording_link.js";

/** Milliseconds that the kernel has for its first answer. */
const DELAY = 900;
/** Milliseconds after which the reader is told that this is a snapshot. */
const PATIENCE = 4000;
const SENTENCE = "No kernel is running for this mesh: this is how it was last. Run the cell to edit it.";

export class RestoredLink {
  constructor(kernel, snapshot) {
    this.view = kernel.view;
    this.onmessage = () => {};
    this._kernel = kernel;
    this._recording = null;
    this._live = false;
    kernel.onmessage = (content, buffers) => this._fromKernel(content, buffers);
    this._timers = [
      setTimeout(() => this._freeze(snapshot), DELAY),
      setTimeout(() => this._tell(), PATIENCE),
    ];
  }

  get readOnly() {
    return this._recording !== null;
  }

  /** Send a request to the recording while it is shown, else to Python. */
  send(word, fields = {}) {
    return (this._recording || this._kernel).send(word, fields);
  }

  close() {
    this._timers.forEach(clearTimeout);
    if (this._recording) this._recording.close();
    this._kernel.close();
  }

  _freeze(snapshot) {
    if (this._live) return;
    const recording = new RecordingLink(snapshot);
    recording.view = this.view;
    recording.onmessage = (content, buffers) => {
      if (this._recording === recording) this.onmessage(content, buffers);
    };
    this._recording = recording;
    recording.send("hello");
  }

  _tell() {
    if (this._recording) this.onmessage({ type: "notice", tone: "info", sentence: SENTENCE }, []);
  }

  _fromKernel(content, buffers) {
    if (content.type === "state" && !this._live) {
      this._live = true;
      if (this._recording) this._recording.close();
      this._recording = null;
    }
    // without a kernel the only message is that the request could not be sent
    if (this._live || !this._recording) this.onmessage(content, buffers);
  }
}
