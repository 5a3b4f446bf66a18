// Every menu with its keys, as data: where a key leads, or what it does, and who may press it.

/**
 * @typedef {object} MenuKey
 * @property {number} key number of the function key, 1 to 10
 * @property {import("../core/texts.js").Said} label
 * @property {string} [menu] the menu it opens
 * @property {string} [screen] the screen it opens
 * @property {any} [args] for the screen
 * @property {string} [action] what it does: a name in motion/actions.js
 * @property {string} [role] least role
 * @property {string} [can] the command whose interlock bars the key
 * @property {string} [pressed] the status bit that shows it pressed
 * @property {string} [style] "danger" or "is-stop"
 */

const MAIN = /** @type {MenuKey} */ ({ key: 10, label: { en: "MAIN MENU", de: "HAUPT\u00adMENÜ" }, menu: "main" });
const form = (/** @type {string} */ name) => ({ screen: "form", args: { form: name } });

/** @type {Record<string, MenuKey[]>} */
export const MENUS = {
  main: [
    { key: 1, label: { en: "HOME", de: "REFE\u00adRENZ" }, screen: "home", role: "operate", style: "danger" },
    { key: 2, label: "menu.clrzero", action: "clearZero", role: "operate" },
    { key: 3, label: "menu.setzero", screen: "zero", role: "operate" },
    { key: 4, label: "menu.edit", screen: "edit" },
    { key: 5, label: { en: "RUN SETUP", de: "EIN\u00adRICHTEN" }, menu: "setup" },
    { key: 6, label: { en: "RUN PROG", de: "PRO\u00adGRAMM" }, menu: "run" },
    { key: 7, label: { en: "MANUAL", de: "HAND" }, menu: "manual" },
    { key: 8, label: { en: "SET/\u200bDIAG", de: "SETUP/\u200bDIAGN." }, menu: "diag" },
    { key: 9, label: { en: "HELP", de: "HILFE" }, screen: "help" },
    { key: 10, label: "menu.exit", action: "exit" },
  ],
  setup: [
    { key: 1, label: { en: "CMP RAD", de: "RADIUS" }, ...form("CMPRAD") },
    { key: 3, label: { en: "LOAD PROG", de: "LADEN" }, screen: "load", role: "operate" },
    { key: 4, label: "menu.feedrate", ...form("FEEDRATE") },
    { key: 6, label: "menu.pparm", screen: "pparm" },
    { key: 7, label: { en: "SET MODALS", de: "G-CODES" }, ...form("MODALS") },
    MAIN,
  ],
  run: [
    { key: 1, label: "menu.stop", action: "stop", style: "is-stop" },
    { key: 2, label: "menu.start", action: "start", role: "operate", can: "run.begin", style: "danger" },
    { key: 3, label: "menu.runline", action: "runLine", role: "operate", can: "run.begin" },
    { key: 4, label: "menu.dryrun", action: "dryRun", role: "operate", can: "run.begin", pressed: "dry" },
    { key: 5, label: "menu.feedrate", ...form("FEEDRATE") },
    { key: 6, label: "menu.fov", screen: "overrides" },
    { key: 7, label: { en: "BLOCK", de: "EINZEL\u00adSATZ" }, action: "block", role: "operate", pressed: "single" },
    { key: 8, label: "menu.setzero", screen: "zero", role: "operate" },
    { key: 9, label: "menu.edit", screen: "edit", args: { other: true } },
    MAIN,
  ],
  stop: [
    { key: 1, label: { en: "ABORT", de: "AB\u00adBRUCH" }, action: "abort", role: "operate", style: "is-stop" },
    { key: 3, label: { en: "BACK", de: "RÜCK\u00adWÄRTS" }, action: "traceBack", role: "operate" },
    { key: 4, label: { en: "HALT", de: "HALT" }, action: "traceStop", role: "operate" },
    { key: 5, label: { en: "FOR\u00adWARD", de: "VOR\u00adWÄRTS" }, action: "traceForward", role: "operate" },
    { key: 6, label: "menu.jog", screen: "jog", role: "operate" },
    { key: 8, label: "menu.resume", action: "resume", role: "operate", style: "danger" },
    MAIN,
  ],
  manual: [
    { key: 1, label: { en: "MDI", de: "MDI" }, screen: "mdi", role: "operate" },
    { key: 2, label: "menu.jog", screen: "jog", role: "operate" },
    { key: 3, label: { en: "HAND WHEEL", de: "HAND\u00adRAD" }, screen: "handwheel", role: "operate" },
    { key: 4, label: "menu.teach", screen: "teach", role: "setup" },
    { key: 8, label: "menu.gotozero", action: "gotoZero", role: "operate", style: "danger" },
    MAIN,
  ],
  diag: [
    { key: 1, label: { en: "SYS PARAM", de: "SYSTEM\u00adPARAM" }, screen: "parameters", role: "service" },
    { key: 2, label: "menu.pparm", screen: "pparm" },
    { key: 3, label: { en: "OFFSETS", de: "KORREK\u00adTUREN" }, screen: "offsets" },
    { key: 4, label: { en: "WORK COORD", de: "NULL\u00adPUNKTE" }, ...form("WORK") },
    { key: 5, label: { en: "DIAG\u00adNOSTICS", de: "DIAG\u00adNOSE" }, menu: "diagnostics" },
    { key: 6, label: { en: "PROG/\u200bPLC", de: "PROG/\u200bSPS" }, screen: "programs" },
    { key: 7, label: { en: "DIS\u00adPLAY", de: "ANZEIGE" }, menu: "display" },
    MAIN,
  ],
  diagnostics: [
    { key: 1, label: { en: "I/O STATUS", de: "E/A STATUS" }, screen: "io" },
    { key: 2, label: { en: "TERMI\u00adNAL", de: "TERMI\u00adNAL" }, screen: "terminal", role: "service" },
    { key: 3, label: { en: "SCOPE", de: "SCOPE" }, screen: "scope", role: "service" },
    { key: 4, label: { en: "GAIN", de: "REGLER" }, screen: "gain", role: "service" },
    { key: 5, label: { en: "BOARD PARAM", de: "KARTEN\u00adPARAM" }, screen: "board", role: "service" },
    { key: 6, label: { en: "SERVO LOOP", de: "REGEL\u00adKREIS" }, screen: "servo" },
    { key: 7, label: { en: "CPU LOAD", de: "CPU-LAST" }, screen: "cpu", role: "setup" },
    { key: 8, label: { en: "FAST STATUS", de: "FAST STATUS" }, screen: "fast" },
    { key: 9, label: { en: "MEMORY CONFIG", de: "SPEI\u00adCHER" }, screen: "memory", role: "service" },
    MAIN,
  ],
  display: [
    { key: 1, label: { en: "BUTTON PANEL", de: "TASTEN\u00adFELD" }, ...form("BUTTONS") },
    { key: 2, label: "menu.fov", screen: "overrides" },
    { key: 3, label: { en: "I/O NAMES", de: "E/A NAMEN" }, ...form("IONAMES") },
    { key: 7, label: { en: "RESIZE SCREEN", de: "FENSTER ZURÜCK" }, action: "resize" },
    { key: 8, label: { en: "USER MES\u00adSAGES", de: "MEL\u00adDUNGEN" }, ...form("MESSAGES") },
    { key: 9, label: { en: "SETUP SCREEN", de: "ANSICH\u00adTEN" }, screen: "views" },
    MAIN,
  ],
};
