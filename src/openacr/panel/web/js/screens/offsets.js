// OFFSETS: radii and lengths, ballscrew, backlash and reference points.
import { t } from "../core/texts.js";
import { showBallscrew } from "../frame/ballscrew.js";
import { showFormTabs } from "../frame/form_tabs.js";

const TEXTS = { title: { en: "Ballscrew", de: "Ballscrew" } };

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "Offsets", de: "Korrekturen" },
  area: "full",
  show: (place) =>
    showFormTabs(place, (form) => form.section === "OFFSETS" && form.name !== "WORK", [
      { name: "BALLSCREW", title: t(TEXTS.title), before: "BACKLASH", show: showBallscrew },
    ]),
};
