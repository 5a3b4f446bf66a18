// Every menu with its keys, as data: where a key leads, or what it does, and who may press it.

/**
 * @typedef {object} MenuKey
 * @property {number} key number of the function key, 1 to 10
 * @property {import("../core/texts.js").TextKey} label
 * @property {string} [menu] the menu it opens
 * @property {string} [screen] the screen it opens
 * @property {any} [args] for the screen
 * @property {string} [action] what it does: a name in motion/actions.js
 * @property {string} [role] least role
 * @property {string} [can] the command whose interlock bars the key
 * @property {string} [pressed] the status bit that shows it pressed
 * @property {string} [style] "danger" or "is-stop"
 */

const MAIN = /** @type {MenuKey} */ ({ key: 10, label: "menu.main", menu: "main" });
const form = (/** @type {string} */ name) => ({ screen: "form", args: { form: name } });

/** @type {Record<string, MenuKey[]>} */
export const MENUS = {
  main: [
    { key: 1, label: "menu.home", screen: "home", role: "operate", style: "danger" },
    { key: 2, label: "menu.clrzero", action: "clearZero", role: "operate" },
    { key: 3, label: "menu.setzero", screen: "zero", role: "operate" },
    { key: 4, label: "menu.edit", screen: "edit" },
    { key: 5, label: "menu.setup", menu: "setup" },
    { key: 6, label: "menu.run", menu: "run" },
    { key: 7, label: "menu.manual", menu: "manual" },
    { key: 8, label: "menu.diag", menu: "diag" },
    { key: 9, label: "menu.help", screen: "help" },
    { key: 10, label: "menu.exit", action: "exit" },
  ],
  setup: [
    { key: 1, label: "menu.cmprad", ...form("CMPRAD") },
    { key: 3, label: "menu.load", screen: "load", role: "operate" },
    { key: 4, label: "menu.feedrate", ...form("FEEDRATE") },
    { key: 6, label: "menu.pparm", screen: "pparm" },
    { key: 7, label: "menu.modals", ...form("MODALS") },
    MAIN,
  ],
  run: [
    { key: 1, label: "menu.stop", action: "stop", style: "is-stop" },
    { key: 2, label: "menu.start", action: "start", role: "operate", can: "run.begin", style: "danger" },
    { key: 3, label: "menu.runline", action: "runLine", role: "operate", can: "run.begin" },
    { key: 4, label: "menu.dryrun", action: "dryRun", role: "operate", can: "run.begin", pressed: "dry" },
    { key: 5, label: "menu.feedrate", ...form("FEEDRATE") },
    { key: 6, label: "menu.fov", screen: "overrides" },
    { key: 7, label: "menu.block", action: "block", role: "operate", pressed: "single" },
    { key: 8, label: "menu.setzero", screen: "zero", role: "operate" },
    { key: 9, label: "menu.edit", screen: "edit", args: { other: true } },
    MAIN,
  ],
  stop: [
    { key: 1, label: "menu.abort", action: "abort", role: "operate", style: "is-stop" },
    { key: 3, label: "menu.back", action: "traceBack", role: "operate" },
    { key: 4, label: "menu.halt", action: "traceStop", role: "operate" },
    { key: 5, label: "menu.forward", action: "traceForward", role: "operate" },
    { key: 6, label: "menu.jog", screen: "jog", role: "operate" },
    { key: 8, label: "menu.resume", action: "resume", role: "operate", style: "danger" },
    MAIN,
  ],
  manual: [
    { key: 1, label: "menu.mdi", screen: "mdi", role: "operate" },
    { key: 2, label: "menu.jog", screen: "jog", role: "operate" },
    { key: 3, label: "menu.handwheel", screen: "handwheel", role: "operate" },
    { key: 4, label: "menu.teach", screen: "teach", role: "setup" },
    { key: 8, label: "menu.gotozero", action: "gotoZero", role: "operate", style: "danger" },
    MAIN,
  ],
  diag: [
    { key: 1, label: "menu.sysparam", screen: "parameters", role: "service" },
    { key: 2, label: "menu.pparm", screen: "pparm" },
    { key: 3, label: "menu.offsets", screen: "offsets" },
    { key: 4, label: "menu.work", ...form("WORK") },
    { key: 5, label: "menu.diagnostics", menu: "diagnostics" },
    { key: 6, label: "menu.programs", screen: "programs" },
    { key: 7, label: "menu.display", menu: "display" },
    MAIN,
  ],
  diagnostics: [
    { key: 1, label: "menu.iostatus", screen: "io" },
    { key: 2, label: "menu.terminal", screen: "terminal", role: "service" },
    { key: 3, label: "menu.scope", screen: "scope", role: "service" },
    { key: 4, label: "menu.gain", screen: "gain", role: "service" },
    { key: 5, label: "menu.board", screen: "board", role: "service" },
    { key: 6, label: "menu.servo", screen: "servo" },
    { key: 7, label: "menu.cpu", screen: "cpu", role: "setup" },
    { key: 8, label: "menu.fast", screen: "fast" },
    { key: 9, label: "menu.memory", screen: "memory", role: "service" },
    MAIN,
  ],
  display: [
    { key: 1, label: "menu.buttons", ...form("BUTTONS") },
    { key: 2, label: "menu.fov", screen: "overrides" },
    { key: 3, label: "menu.ionames", ...form("IONAMES") },
    { key: 7, label: "menu.resize", action: "resize" },
    { key: 8, label: "menu.messages", ...form("MESSAGES") },
    { key: 9, label: "menu.views", screen: "views" },
    MAIN,
  ],
};
