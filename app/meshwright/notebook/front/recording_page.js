// The exported HTML page: shows the recording that is embedded in it as JSON.

import { mount } from "./card.js";
import { RecordingLink } from "./link/recording_link.js";

/** Pixels of the page above and below the canvas. */
const HEAD_AND_FOOT = 296;
/** Bounds of the canvas in pixels. */
const LOWEST = 240;
const HIGHEST = 640;

/** Show the recording in #recording inside of #film, as large as the page allows. */
export function showRecording() {
  const recording = JSON.parse(document.getElementById("recording").textContent);
  const element = document.getElementById("film");
  const room = Math.min(innerHeight - HEAD_AND_FOOT, element.clientWidth, HIGHEST);
  mount(element, new RecordingLink(recording), { height: Math.max(room, LOWEST), theme: "auto" });
}
