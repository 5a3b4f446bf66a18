// OFFSETS: radii and lengths, ballscrew, backlash and reference points.
import { showFormTabs } from "../frame/form_tabs.js";

const NAMES = new Set(["R-GEOMETRY", "R-WEAR", "H-GEOMETRY", "H-WEAR", "BALLSCREW", "BACKLASH", "REFERENCE"]);

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "offsets.title",
  area: "full",
  show: (place) => showFormTabs(place, (form) => NAMES.has(form.name)),
};
