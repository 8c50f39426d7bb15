// Texts that describe the mesh and the half-edge under the pointer.

import { asSentence } from "../dom.js";
import { counted, signed } from "../numbers.js";

/** Name of the mesh. */
export function meshName({ name }) {
  return name ? `Mesh ${name}` : "Mesh";
}

/** Description of the canvas and its keys, for screen readers. */
export function canvasLabel(head) {
  const noun = head.kind === "quad" ? "quad" : "triangle";
  return `${meshName(head)}: ${counted(head.elements, noun)}, score ${head.score}, optimum `
    + `${head.optimum}. Arrow keys go from half-edge to half-edge, Return applies the `
    + "previewed operation, M opens the menu, question mark lists all keys.";
}

/** The half-edge in one line, with the reason where the armed operation is refused. */
export function placed(replica, { halfedge, offers, wanted }) {
  const ends = `${replica.origin[halfedge]} \u2192 ${replica.target(halfedge)}`;
  const offer = offers && wanted ? offers.get(wanted) : null;
  const refusal = offer && !offer.allowed ? `  \u00b7  Not here: ${asSentence(offer.reason)}` : "";
  return `Half-edge ${halfedge}:  ${ends}${regionName(replica, halfedge, "  \u00b7  ")}${refusal}`;
}

/** `before` and the name of the region in which a half-edge lies; empty if there is only one. */
function regionName(replica, halfedge, before) {
  if (replica.regions.length < 2) return "";
  const region = replica.region[replica.element(halfedge)];
  return before + (replica.regions[region] || `Region ${region + 1}`);
}

/** The half-edge in words: ends, degrees, and the effect of the previewed operation. */
export function described({ replica, hoverState }) {
  const h = hoverState.halfedge;
  if (!replica.live(h)) return "No half-edge.";
  const end = (at) => {
    const delta = replica.delta[replica.origin[at]];
    return `vertex ${replica.origin[at]}, degree ${replica.degree(at)}, ${delta ? signed(delta) : "regular"}`;
  };
  const side = (replica.twin[h] < 0 ? ", on the boundary" : replica.constrained(h) ? ", on an interface" : "")
    + regionName(replica, h, ", in ");
  const info = replica.catalogue.find((one) => one.operation === hoverState.previewed);
  const meant = info ? ` ${info.title}: s ${signed(hoverState.ghost.change)}.` : "";
  return `Half-edge ${h}${side}, from ${end(h)}, to ${end(replica.next(h))}.${meant}`;
}
