// Every pane of the workspace, as data: its title, who may use it, its module, and how many there may be.
import { modulePane, screenPane, tabPane } from "./adapters.js";

/**
 * @typedef {object} Place what a pane gets
 * @property {HTMLElement} head for keys above the pane
 * @property {number} number which of several panes of its kind, from 1
 * @property {Record<string, any>} kept what the layout keeps of the pane
 * @property {(values: Record<string, any>) => void} keep have the layout keep values
 * @property {(ask: () => boolean | Promise<boolean>) => void} beforeClose asked before the pane is closed
 *
 * @typedef {(host: HTMLElement, place: Place) => (() => void) | Promise<() => void>} Mount
 * @typedef {{ title: import("../core/texts.js").Said, role?: string, most?: number, isLarge?: boolean,
 *   load: () => Promise<Mount> }} Pane `isLarge`: it opens in the largest place
 */

/** @type {Record<string, Pane>} */
export const PANES = {
  terminal: {
    title: "terminal.title",
    role: "service",
    most: 4,
    load: modulePane(() => import("../panes/terminal.js")),
  },
  status: { title: { en: "Status", de: "Zustand" }, most: 8, load: modulePane(() => import("./panes/status.js")) },
  programs: { title: { en: "Programs", de: "Programme" }, load: screenPane(() => import("../screens/programs.js")) },
  editor: {
    title: { en: "Editor", de: "Editor" },
    most: 4,
    isLarge: true,
    load: modulePane(() => import("./panes/editor.js")),
  },
  project: { title: { en: "Project", de: "Projekt" }, load: modulePane(() => import("./panes/project.js")) },
  variables: {
    title: { en: "Variables", de: "Variablen" },
    most: 4,
    load: modulePane(() => import("./panes/variables.js")),
  },
  plc: { title: { en: "PLC", de: "PLC" }, load: tabPane(async () => (await import("../frame/tab_plc.js")).plcTab) },
  servo: { title: "servo.title", load: screenPane(() => import("../screens/servo.js")) },
  jog: { title: "jog.title", role: "operate", load: modulePane(() => import("./panes/jog.js")) },
  drives: {
    title: { en: "Drives", de: "Antriebe" },
    role: "operate",
    load: modulePane(() => import("./panes/drives.js")),
  },
  gain: {
    title: { en: "Gains", de: "Verst\u00e4rkungen" },
    role: "service",
    load: screenPane(() => import("../screens/gain.js")),
  },
  tune: {
    title: { en: "Tuning", de: "Einstellen" },
    role: "service",
    isLarge: true,
    load: modulePane(() => import("./panes/tune.js")),
  },
  scope: { title: "scope.title", role: "service", isLarge: true, load: modulePane(() => import("./panes/scope.js")) },
  tree: { title: "pane.tree", load: modulePane(() => import("./panes/tree.js")) },
  uses: { title: { en: "Cross reference", de: "Querverweise" }, load: modulePane(() => import("./panes/uses.js")) },
  watch: { title: { en: "Watch list", de: "Beobachten" }, load: modulePane(() => import("./panes/watch.js")) },
  io: { title: { en: "I/O", de: "E/A" }, load: tabPane(async () => (await import("../frame/tab_io.js")).ioTab) },
  board: { title: "board.title", role: "service", load: screenPane(() => import("../screens/board.js")) },
  world: { title: { en: "World", de: "Welt" }, isLarge: true, load: modulePane(() => import("./panes/world.js")) },
  wizard: {
    title: { en: "Configuration", de: "Konfiguration" },
    role: "service",
    isLarge: true,
    load: modulePane(() => import("./panes/wizard.js")),
  },
  timeline: {
    title: { en: "Timeline", de: "Zeitachse" },
    role: "service",
    isLarge: true,
    load: modulePane(() => import("./panes/timeline.js")),
  },
  alarms: {
    title: { en: "ALARMS", de: "ALARME" },
    load: tabPane(async () => (await import("../frame/tab_alarms.js")).alarmsTab),
  },
};
