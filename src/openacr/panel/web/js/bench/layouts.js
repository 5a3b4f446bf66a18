// Layouts of the panes that this browser keeps: the present one, and those with names.
import { keepSetting, setting } from "../core/settings.js";

/**
 * @typedef {import("../../vendor/dockview.js").SerializedDockview} Layout
 * @typedef {{ pane: string, kept?: Record<string, any>, beside?: string,
 *   direction?: "left" | "right" | "above" | "below" | "within", share?: number }} Part
 */

/** The first layout: each pane beside another one. @type {Part[]} */
export const FIRST = [
  { pane: "programs" },
  { pane: "status", beside: "programs", direction: "within" },
  { pane: "servo", beside: "programs", direction: "right" },
  { pane: "io", beside: "servo", direction: "within" },
  { pane: "plc", beside: "servo", direction: "within" },
  { pane: "tree", beside: "servo", direction: "within" },
  { pane: "terminal", beside: "servo", direction: "below" },
  { pane: "watch", beside: "terminal", direction: "within" },
  { pane: "alarms", beside: "terminal", direction: "within" },
];

/** @param {"wide" | "narrow"} form */
export function presentLayout(form) {
  return parsed(setting(`bench.${form}`, ""));
}

/**
 * @param {"wide" | "narrow"} form
 * @param {Layout | null} layout null: the first one from now on
 */
export function keepLayout(form, layout) {
  keepSetting(`bench.${form}`, layout ? JSON.stringify(layout) : "");
}

/** @returns {Record<string, Layout>} */
export function namedLayouts() {
  const found = parsed(setting("bench.named", ""));
  return typeof found === "object" && found !== null ? found : {};
}

/** @param {Record<string, Layout>} layouts */
export function keepNamedLayouts(layouts) {
  keepSetting("bench.named", JSON.stringify(layouts));
}

/** @param {string} text */
function parsed(text) {
  try {
    return text ? JSON.parse(text) : null;
  } catch {
    return null; // another version, or another hand, has written it
  }
}
