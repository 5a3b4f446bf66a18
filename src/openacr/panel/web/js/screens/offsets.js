// OFFSETS: radii and lengths, ballscrew, backlash and reference points.
import { t } from "../core/texts.js";
import { showBallscrew } from "../frame/ballscrew.js";
import { showFormTabs } from "../frame/form_tabs.js";

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "offsets.title",
  area: "full",
  show: (place) => showFormTabs(place, (form) => form.section === "OFFSETS" && form.name !== "WORK",
    [{ name: "BALLSCREW", title: t("ballscrew.title"), before: "BACKLASH", show: showBallscrew }]),
};
