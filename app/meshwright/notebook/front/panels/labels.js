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
export function placed(replica, { halfedge, offers, wanted }) {
  const ends = `${replica.origin[halfedge]} \u2192 ${replica.target(halfedge)}`;
  const offer = offers && wanted ? offers.get(wanted) : null;
  const refusal = offer && !offer.allowed ? `  \u00b7  Not here: ${asSentence(offer.reason)}` : "";
  return `Half-edge ${halfedge}:  ${ends}${refusal}`;
}

/** What is pointed at, in words: ends, degrees, and what the operation meant would do. */
export function described({ replica, hoverState }) {
  const h = hoverState.halfedge;
  if (!replica.live(h)) return "No half-edge.";
  const end = (at) => {
    const delta = replica.delta[replica.origin[at]];
    return `vertex ${replica.origin[at]}, degree ${replica.degree(at)}, ${delta ? signed(delta) : "regular"}`;
  };
  const side = replica.twin[h] < 0 ? ", on the boundary" : "";
  const info = replica.catalogue.find((one) => one.operation === hoverState.meant);
  const meant = info ? ` ${info.title}: s ${signed(hoverState.ghost.change)}.` : "";
  return `Half-edge ${h}${side}, from ${end(h)}, to ${end(replica.next(h))}.${meant}`;
}
