// Creates DOM elements.

import { ICON_STROKES } from "./generated/constants.js";

/** An element with a class, attributes (true: present, false or null: not) and children. */
export function node(tag, name = "", attributes = {}, ...children) {
  const made = document.createElement(tag);
  if (name) made.className = name;
  for (const [key, value] of Object.entries(attributes)) {
    if (value === true) made.setAttribute(key, "");
    else if (value !== false && value !== null && value !== undefined) made.setAttribute(key, value);
  }
  made.append(...children.filter((child) => child !== null));
  return made;
}

/** An icon of meshwright.graphics.icon_paths, in the colour of the surrounding text. */
export function icon(name, size = 18) {
  return drawn(ICON_STROKES[name], { class: "mw-icon", width: size, height: size });
}

/** An SVG of one path in a square of 20, or in another `viewBox`. */
export function drawn(path, attributes = {}) {
  const space = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(space, "svg");
  const line = document.createElementNS(space, "path");
  for (const [key, value] of Object.entries({ viewBox: "0 0 20 20", "aria-hidden": "true", ...attributes })) {
    svg.setAttribute(key, value);
  }
  line.setAttribute("d", path);
  svg.append(line);
  return svg;
}

/** A button with an icon, text or both; `label` is its accessible name and tooltip. */
export function button(name, label, { sign = null, text = "", act = null } = {}) {
  const made = node("button", name, { type: "button", "aria-label": label, title: label });
  if (sign) made.append(icon(sign));
  if (text) made.append(node("span", "", {}, text));
  if (act) made.addEventListener("click", act);
  return made;
}

/** Set the text if it differs, which avoids a layout. */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** `text` with a capital first letter and a full stop. */
export function asSentence(text) {
  const begun = text.charAt(0).toUpperCase() + text.slice(1);
  return /[.!?\u2026]$/.test(begun) ? begun : `${begun}.`;
}
