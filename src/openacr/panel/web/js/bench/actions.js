// What the workspace does by a key of the keyboard: one table for the bar, the list of shortcuts and the search.
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { ask } from "../frame/dialog.js";
import { chooseLayout, choosePane } from "./layout_dialogs.js";
import { JOBS } from "./layouts.js";
import { isPressed, shownKeys } from "./shown_keys.js";
import { chooseJob, closePane, openPane, showPaneAt } from "./workspace.js";

const TEXTS = {
  keys: { en: "SHORTCUTS", de: "TASTEN" },
  search: { en: "SEARCH", de: "SUCHEN" },
  nine: { en: "Show an open pane, in their order", de: "Ein offenes Fenster zeigen, in ihrer Reihenfolge" },
  editor: { en: "Show the editor", de: "Den Editor zeigen" },
  terminal: { en: "Show a terminal", de: "Ein Terminal zeigen" },
  run: { en: "RUN of the program chosen in Programs", de: "START des in Programme gew\u00e4hlten Programms" },
  step: { en: "STEP of the program chosen in Programs", de: "SCHRITT des in Programme gew\u00e4hlten Programms" },
  menu: {
    en: "Menu of a parameter or flag, which the mouse can also drag into a pane",
    de: "Men\u00fc zu Parameter oder Flag; die Maus zieht sie auch in ein Fenster",
  },
  stop: { en: "STOP: feed hold", de: "STOPP: Vorschub halt" },
};

/**
 * @typedef {{ title: import("../core/texts.js").Said, keys: string, does: () => unknown }} Action `keys`: the modifiers
 *   and the key as they are on an English keyboard, two ways with a comma between them
 * @typedef {keyof typeof ACTIONS} ActionName
 */

export const ACTIONS = /** @satisfies {Record<string, Action>} */ ({
  search: { title: TEXTS.search, keys: "Ctrl+K", does: async () => (await import("./palette.js")).openPalette() },
  program: { title: JOBS.program.title, keys: "Ctrl+Alt+1", does: () => chooseJob("program") },
  tune: { title: JOBS.tune.title, keys: "Ctrl+Alt+2", does: () => chooseJob("tune") },
  watch: { title: JOBS.watch.title, keys: "Ctrl+Alt+3", does: () => chooseJob("watch") },
  panes: { title: "bench.panes", keys: "Alt+P", does: choosePane },
  layouts: { title: "bench.layouts", keys: "Alt+L", does: chooseLayout },
  close: { title: "bench.close", keys: "Alt+W", does: closePane },
  editor: { title: TEXTS.editor, keys: "Alt+E", does: () => openPane("editor") },
  terminal: { title: TEXTS.terminal, keys: "Alt+T", does: () => openPane("terminal") },
  run: { title: TEXTS.run, keys: "Alt+R", does: () => ofPrograms("run") },
  step: { title: TEXTS.step, keys: "Alt+S", does: () => ofPrograms("step") },
  keys: { title: TEXTS.keys, keys: "F1, ?", does: showShortcuts },
});

const COUNT = 9; // panes that a digit shows

/** What modules of panes and of the frame bind themselves, for the list alone. @type {[string, import("../core/texts.js").Said][]} */
const OTHERS = [
  [`Alt+1 \u2026 Alt+${COUNT}`, TEXTS.nine],
  ["Shift+F10", TEXTS.menu],
  ["Pause", TEXTS.stop],
];

/** Bind the table: it acts in the editor and in the terminal, too, but not over a dialog. */
export function startActions() {
  const digits = Array.from({ length: COUNT }, (_each, n) => ({ keys: `Alt+${n + 1}`, does: () => showPaneAt(n) }));
  const bound = [...Object.values(ACTIONS), ...digits];
  window.addEventListener(
    "keydown",
    (event) => {
      const action = bound.find(({ keys }) => keys.split(", ").some((each) => isMeant(event, each)));
      if (!action || document.querySelector("dialog[open]")) return;
      event.preventDefault();
      event.stopPropagation();
      if (!event.repeat) void action.does();
    },
    { capture: true },
  );
}

/**
 * A sign alone counts only where nothing is typed.
 * @param {KeyboardEvent} event
 * @param {string} keys
 */
function isMeant(event, keys) {
  if (keys !== "?") return isPressed(event, keys);
  return event.key === "?" && !event.ctrlKey && !event.altKey && !event.metaKey && !isTyping(event.target);
}

/** @param {EventTarget | null} target */
function isTyping(target) {
  return (
    target instanceof HTMLElement &&
    (target.isContentEditable || target.matches("input, textarea, select, .editor-host *"))
  );
}

function showShortcuts() {
  const rows = [...Object.values(ACTIONS).map(({ keys, title }) => /** @type {const} */ ([keys, title])), ...OTHERS];
  const table = h(
    "table.grid.shortcuts",
    {},
    h(
      "tbody",
      {},
      ...rows.map(([keys, title]) =>
        h("tr", {}, h("th", { scope: "row" }, h("kbd", {}, shownKeys(keys))), h("td", {}, t(title))),
      ),
    ),
  );
  void ask({ title: t(TEXTS.keys), body: [table], choices: [{ text: t("key.close"), value: null }] });
}

/**
 * Press a key of the pane of programs, which is shown first: what it acts on is seen.
 * @param {string} does
 */
function ofPrograms(does) {
  const isSeen = Boolean(document.querySelector("[data-pane=programs] .program-keys")?.checkVisibility());
  if (!isSeen) return openPane("programs");
  const found = document.querySelector(`[data-pane=programs] [data-does=${does}]`);
  if (found instanceof HTMLButtonElement && !found.disabled) found.click();
}
