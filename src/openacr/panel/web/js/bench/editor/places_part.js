// The editor shows a line of a program of the card that another pane leads to.
import { refuse } from "../../core/app.js";
import { takeWanted } from "../wanted.js";

/**
 * @typedef {import("../../edit/line_marks.js").StoredLines} StoredLines
 * @param {{ opened: () => import("./card_text.js").Opened,
 *   stored: (level: string) => Promise<StoredLines | null>,
 *   editor: () => ReturnType<typeof import("../../edit/controller_editor.js").createControllerEditor>,
 *   choice: HTMLSelectElement, chooseLevel: () => Promise<void> }} pane `stored`: which line of the text the card has
 *   under which number
 * @returns {() => void} ends it
 */
export function followPlaces({ opened, stored, editor, choice, chooseLevel }) {
  async function show(/** @type {string} */ level, /** @type {number} */ number, isRead = false) {
    if (opened().level !== level || isRead) {
      choice.value = level;
      await chooseLevel();
    }
    if (opened().level !== level) return; // it has changes that are kept
    const at = (await stored(level))?.at(level, number) ?? null;
    if (at === null) return editor().focus();
    const line = editor().doc().lineAt(at).number - 1;
    editor().goTo([line, 0, line, 0]);
  }
  return takeWanted(
    "editor",
    ([level = "", line, read]) => void show(level, Number(line), read === "read").catch(refuse),
  );
}
