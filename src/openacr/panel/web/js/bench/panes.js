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
 *   past?: import("../core/texts.js").Said, load: () => Promise<Mount> }} Pane `isLarge`: it opens in the largest place;
 *   `past`: what it shows while the card is at a moment of its history, unless that is the moment
 */

/** @type {Record<string, Pane>} */
export const PANES = {
  terminal: {
    title: "terminal.title",
    role: "service",
    most: 4,
    past: {
      en: "A moment of the past has no terminal: what is shown was printed before.",
      de: "Ein Zeitpunkt der Vergangenheit hat kein Terminal: Was hier steht, wurde vorher ausgegeben.",
    },
    load: modulePane(() => import("../panes/terminal.js")),
  },
  status: { title: { en: "Status", de: "Zustand" }, most: 8, load: modulePane(() => import("./panes/status.js")) },
  programs: { title: { en: "Programs", de: "Programme" }, load: screenPane(() => import("../screens/programs.js")) },
  editor: {
    title: { en: "Editor", de: "Editor" },
    most: 4,
    isLarge: true,
    past: {
      en: "The text stays as it was opened. READ and COMPARE take that of the moment; nothing is sent to it.",
      de: "Der Text bleibt, wie er ge\u00f6ffnet wurde. LESEN und VERGLEICHEN nehmen den des Zeitpunkts; gesendet wird nichts.",
    },
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
  jog: {
    title: "jog.title",
    role: "operate",
    past: {
      en: "At a moment of the past no axis is moved: OPERATE FROM HERE of Timeline continues from it.",
      de: "An einem Zeitpunkt der Vergangenheit wird keine Achse bewegt: VON HIER BEDIENEN der Zeitachse macht dort weiter.",
    },
    load: modulePane(() => import("./panes/jog.js")),
  },
  drives: {
    title: { en: "Drives", de: "Antriebe" },
    role: "operate",
    load: modulePane(() => import("./panes/drives.js")),
  },
  bus: {
    title: { en: "Bus", de: "Bus" },
    past: {
      en: "A card with a bus has no timeline: this is the bus of the present.",
      de: "Eine Karte mit Bus hat keine Zeitachse: Das ist der Bus von jetzt.",
    },
    load: modulePane(() => import("./panes/bus.js")),
  },
  gain: {
    title: { en: "Gains", de: "Verst\u00e4rkungen" },
    role: "service",
    past: {
      en: "These are the parameters of the machine as they are stored now. Servo loop shows the gains of the moment.",
      de: "Das sind die Parameter der Maschine, wie sie jetzt gespeichert sind. Regelkreis zeigt die Verst\u00e4rkungen des Zeitpunkts.",
    },
    load: screenPane(() => import("../screens/gain.js")),
  },
  tune: {
    title: { en: "Tuning", de: "Einstellen" },
    role: "service",
    isLarge: true,
    past: {
      en: "Measurement and gains are those of the last time the card was operated: at a moment of the past nothing is measured.",
      de: "Messung und Verst\u00e4rkungen sind die des letzten Betriebs der Karte: An einem Zeitpunkt der Vergangenheit wird nichts gemessen.",
    },
    load: modulePane(() => import("./panes/tune.js")),
  },
  scope: {
    title: "scope.title",
    role: "service",
    isLarge: true,
    past: {
      en: "Samples are of the time when they were taken. START takes those of what RUN of Timeline repeats.",
      de: "Messwerte sind aus der Zeit, in der sie genommen wurden. START nimmt die von dem, was WEITER der Zeitachse wiederholt.",
    },
    load: modulePane(() => import("./panes/scope.js")),
  },
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
    past: {
      en: "These are answers for files: no moment of the card changes them.",
      de: "Das sind Antworten f\u00fcr Dateien: Kein Zeitpunkt der Karte \u00e4ndert sie.",
    },
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
