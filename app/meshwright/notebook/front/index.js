// Entry point of the bundle.
//
// render({model, el}) is called by anywidget for every view of a widget; showRecording() by the
// exported HTML page.
//
// For tests and scripts, on the element of class "meshwright": data-revision (of the mesh that is
// painted), data-painted (number of paints), data-halfedge (under the pointer, -1 for none),
// data-meant (the operation whose preview is shown), data-agent (state of the agent); and
// `element.meshwright` is the Card, whose screenOf(halfedge) gives the {x, y} of a half-edge on the
// page.

import { mount } from "./card.js";
import { KernelLink } from "./link/kernel_link.js";
import { RestoredLink } from "./link/restored_link.js";
import { SavedStill } from "./link/saved_still.js";

export { showRecording } from "./recording_page.js";

/** A valid height of the canvas: marimo keeps what a page has set even if Python refused it. */
function canvasHeight(height) {
  return Number.isFinite(height) ? Math.min(Math.max(height, 160), 4000) : 464;
}

/** Show one view of an anywidget model in `el`; returns the function that removes it. */
export function render({ model, el }) {
  const kernel = new KernelLink(model);
  const snapshot = model.get("snapshot");
  const link = snapshot && snapshot.state ? new RestoredLink(kernel, snapshot) : kernel;
  const options = () => ({ height: canvasHeight(model.get("height")), theme: model.get("theme") });
  const card = mount(el, link, options());
  const still = new SavedStill(model, kernel);
  const onChange = () => card.configure(options());
  for (const name of ["height", "theme"]) model.on(`change:${name}`, onChange);
  return () => {
    for (const name of ["height", "theme"]) model.off(`change:${name}`, onChange);
    still.close();
    card.release();
  };
}
