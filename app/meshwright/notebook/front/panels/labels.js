// What is said of the mesh and of what is pointed at.

import { asSentence } from "../dom.js";
import { counted, signed } from "../numbers.js";

/** What the mesh is called. */
export function meshName({ name }) {
  return name ? `Mesh ${name}` : "Mesh";
}

/** What the canvas is, and how to use it, for those who cannot see it. */
export function canvasLabel(head) {
  const noun = head.kind === "quad" ? "quad" : "triangle";
  return `${meshName(head)}: ${counted(head.elements, noun)}, score ${head.score}, optimum `
    + `${head.optimum}. Arrow keys walk from half-edge to half-edge, Return does the operation `
    + "shown, M opens the menu, question mark lists all keys.";
}

/** What is pointed at, in a line; with the reason where the operation that is armed is refused. */
export function placed(mirror, { halfedge, offers, wanted }) {
  const ends = `${mirror.origin[halfedge]} \u2192 ${mirror.target(halfedge)}`;
  const offer = offers && wanted ? offers.get(wanted) : null;
  const refusal = offer && !offer.allowed ? `  \u00b7  Not here: ${asSentence(offer.reason)}` : "";
  return `Half-edge ${halfedge}:  ${ends}${refusal}`;
}

/** What is pointed at, in words: ends, degrees, and what the operation meant would do. */
export function described({ mirror, pointing }) {
  const h = pointing.halfedge;
  if (!mirror.live(h)) return "No half-edge.";
  const end = (at) => {
    const delta = mirror.delta[mirror.origin[at]];
    return `vertex ${mirror.origin[at]}, degree ${mirror.degree(at)}, ${delta ? signed(delta) : "regular"}`;
  };
  const side = mirror.twin[h] < 0 ? ", on the boundary" : "";
  const info = mirror.catalogue.find((one) => one.operation === pointing.meant);
  const meant = info ? ` ${info.title}: s ${signed(pointing.ghost.change)}.` : "";
  return `Half-edge ${h}${side}, from ${end(h)}, to ${end(mirror.next(h))}.${meant}`;
}
