// I/O STATUS as a full page.
import { ioTab } from "../frame/tab_io.js";

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "I/O status", de: "E/A-Status" },
  help: {
    en:
      "Every input and output of the card and of its expansion modules, live, with the names of I/O NAMES. The " +
      "numbers are those of the flags of the card.",
    de:
      "Jeder Eingang und Ausgang der Karte und ihrer Erweiterungen, laufend, mit den Namen aus E/A NAMEN. Die " +
      "Nummern sind die der Bits der Karte.",
  },
  area: "full",
  show: ({ body, endings }) => ioTab(body, endings),
};
