// I/O STATUS as a full page.
import { ioTab } from "../frame/tab_io.js";

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "I/O status", de: "E/A-Status" },
  area: "full",
  show: ({ body, endings }) => ioTab(body, endings),
};
