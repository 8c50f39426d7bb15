// The static picture in a notebook's file follows the mesh.
//
// Beside the widget a cell's output holds a PNG, for viewers that show no widgets: GitHub,
// `jupyter nbconvert`. JupyterLab and Jupyter Notebook write their shared model of the notebook into
// the file, and it is replaced there; the output on the page is not drawn again. Elsewhere (VS Code,
// Colab, marimo) a page cannot reach the notebook, and the picture is that of the cell's run.

const VIEW = "application/vnd.jupyter.widget-view+json";
const PNG = "image/png";
/** The origin of changes of the shared model after which JupyterLab draws nothing again. */
const SILENT = "silent-change";

export class SavedStill {
  constructor(model, link) {
    this._model = model;
    this._receive = (content) => {
      if (content && content.type === "still") this._write(content);
    };
    if (!notebookOf(model)) return;
    model.on("msg:custom", this._receive);
    link.send("still"); // from now on the kernel sends each new one
  }

  close() {
    this._model.off("msg:custom", this._receive);
  }

  _write({ model_id, image, metadata }) {
    const notebook = notebookOf(this._model);
    if (!notebook) return;
    try {
      for (const cell of notebook.cells) replace(cell.sharedModel, model_id, image, metadata);
    } catch (error) { // another version of JupyterLab: the file keeps the earlier picture
      console.warn("The picture for the saved notebook was not replaced:", error);
    }
  }
}

/** The notebook that a model's manager belongs to, or null where it gives no way to it. */
function notebookOf(model) {
  const manager = model.widget_manager;
  const notebook = manager && manager.context && manager.context.model;
  return notebook && notebook.cells ? notebook : null;
}

/** Replace the PNG beside the views of a widget in the outputs of a cell. */
function replace(cell, id, image, metadata) {
  if (!cell.getOutputs || !cell.updateOutputs) return; // not a code cell
  cell.getOutputs().forEach((output, at) => {
    const data = output.data || {};
    if (!data[VIEW] || data[VIEW].model_id !== id || data[PNG] === image) return;
    const changed = {
      ...output,
      data: { ...data, [PNG]: image },
      metadata: { ...output.metadata, [PNG]: metadata },
    };
    cell.updateOutputs(at, at + 1, [changed], SILENT);
  });
}
