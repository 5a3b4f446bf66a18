// Layouts of the panes: a first one for each job, what this browser keeps of them, and those with names.
import { keepSetting, setting } from "../core/settings.js";

/**
 * @typedef {import("../../vendor/dockview.js").SerializedDockview} Layout
 * @typedef {{ share: number, panes: string[] } | { share: number, parts: Part[] }} Part panes in one place, the first of
 *   them shown; or parts beside each other, one level deeper above each other
 * @typedef {keyof typeof JOBS} Job
 */

/** What the workspace is used for: the first layout of each, from left to right. */
export const JOBS = Object.freeze({
  program: {
    title: { en: "PROGRAM", de: "PROGRAMM" },
    largest: "editor",
    parts: /** @type {Part[]} */ ([
      { share: 24, panes: ["programs", "plc"] },
      { share: 47, panes: ["editor"] },
      {
        share: 29,
        parts: [
          { share: 45, panes: ["variables", "watch"] },
          { share: 55, panes: ["terminal", "tree", "alarms"] },
        ],
      },
    ]),
  },
  tune: {
    title: { en: "TUNE", de: "EINSTEL\u00adLEN" },
    largest: "tune",
    parts: /** @type {Part[]} */ ([
      {
        share: 24,
        parts: [
          { share: 55, panes: ["jog", "watch", "alarms"] },
          { share: 45, panes: ["gain", "servo"] },
        ],
      },
      { share: 76, panes: ["tune", "scope"] },
    ]),
  },
  watch: {
    title: { en: "WATCH", de: "BEOB\u00adACHTEN" },
    largest: "scope",
    parts: /** @type {Part[]} */ ([
      {
        share: 34,
        parts: [
          { share: 55, panes: ["status", "tree"] },
          { share: 45, panes: ["watch", "io", "alarms"] },
        ],
      },
      {
        share: 66,
        parts: [
          { share: 60, panes: ["scope", "servo"] },
          { share: 40, panes: ["timeline", "plc"] },
        ],
      },
    ]),
  },
});

/** The job that this browser was used for last. @returns {Job} */
export function presentJob() {
  const kept = setting("bench.job", "program");
  return kept in JOBS ? /** @type {Job} */ (kept) : "program";
}

/** @param {Job} job */
export function keepJob(job) {
  keepSetting("bench.job", job);
}

/**
 * All panes of the first layout of a job, in their order.
 * @param {Job} job
 */
export function panesOf(job) {
  /** @type {(part: Part) => string[]} */
  const inside = (part) => ("panes" in part ? part.panes : part.parts.flatMap(inside));
  return JOBS[job].parts.flatMap(inside);
}

/**
 * The first layout of a job for a size; docks keep its shares when the window changes.
 * @param {Job} job
 * @param {{ width: number, height: number }} size
 * @returns {Layout}
 */
export function firstLayout(job, { width, height }) {
  let count = 0;
  /**
   * @param {Part[]} parts
   * @param {number} along pixels that the parts share
   * @param {number} across
   * @returns {any[]}
   */
  const nodes = (parts, along, across) =>
    parts.map((part) => {
      const size = (along * part.share) / 100;
      if ("parts" in part) return { type: "branch", size, data: nodes(part.parts, across, size) };
      const views = part.panes.map((pane) => `${pane}-1`);
      return { type: "leaf", size, data: { id: String(++count), views, activeView: views[0] } };
    });
  const data = nodes(JOBS[job].parts, width, height);
  const panels = panesOf(job).map((pane) => [
    `${pane}-1`,
    { id: `${pane}-1`, contentComponent: pane, tabComponent: "tab", title: pane },
  ]);
  return /** @type {any} */ ({
    grid: { root: { type: "branch", size: height, data }, width, height, orientation: "HORIZONTAL" },
    panels: Object.fromEntries(panels),
  });
}

/**
 * @param {"wide" | "narrow"} form
 * @param {Job} job
 */
export function presentLayout(form, job) {
  return parsed(setting(`bench.${form}.${job}`, ""));
}

/**
 * @param {"wide" | "narrow"} form
 * @param {Job} job
 * @param {Layout | null} layout null: the first one from now on
 */
export function keepLayout(form, job, layout) {
  keepSetting(`bench.${form}.${job}`, layout ? JSON.stringify(layout) : "");
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
