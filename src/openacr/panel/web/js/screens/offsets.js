// OFFSETS: radii and lengths, ballscrew, backlash and reference points.
import { t } from "../core/texts.js";
import { showBallscrew } from "../frame/ballscrew.js";
import { showFormTabs } from "../frame/form_tabs.js";

const TEXTS = { title: { en: "Ballscrew", de: "Ballscrew" } };

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "Offsets", de: "Korrekturen" },
  help: {
    en:
      "Radii (D) and lengths (H) of tools with their wear, fixture offsets, ballscrew tables, backlash, reference " +
      "points. SAVE PAGE stores the page; a value that is refused stays in its field.",
    de:
      "Radien (D) und Längen (H) der Werkzeuge mit ihrem Verschleiß, Vorrichtungskorrekturen, Tabellen der " +
      "Kugelgewindetriebe, Umkehrspiel, Referenzpunkte. SEITE SPEICHERN speichert die Seite; ein abgelehnter Wert " +
      "bleibt in seinem Feld.",
  },
  area: "full",
  show: (place) =>
    showFormTabs(place, (form) => form.section === "OFFSETS" && form.name !== "WORK", [
      { name: "BALLSCREW", title: t(TEXTS.title), before: "BACKLASH", show: showBallscrew },
    ]),
};
