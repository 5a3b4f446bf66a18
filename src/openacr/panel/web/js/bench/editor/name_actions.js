// What is done with names and the whole text: go to, uses, rename, format, outline.
import { refuse } from "../../core/app.js";
import { h } from "../../core/dom.js";
import { t } from "../../core/texts.js";
import { askText } from "../../frame/dialog.js";
import { nameAt } from "../places.js";
import { want } from "../wanted.js";

/**
 * @typedef {{ span: number[], text: string, kind: string, fix?: import("../../edit/language.js").Finding["fix"] }} Item
 *   a place of the text with what is to be said of it
 *
 * @typedef {object} Pane
 * @property {(question: string, about?: object) => Promise<any>} asked the answer about the present text, null without
 *   one
 * @property {() => ReturnType<typeof import("../../edit/controller_editor.js").createControllerEditor>} editor
 * @property {(items: Item[]) => void} list show places below the text
 * @property {(...content: Node[]) => void} showBeside show something beside the text
 *
 * @property {() => string} level of the program that is open; empty for a file
 *
 * @param {Pane} pane
 */
export function nameActions({ level, asked, editor, list, showBeside }) {
  async function definition() {
    const answer = await asked("definitions");
    if (answer?.places.length) editor().goTo(answer.places[0].span);
    else if (answer) refuse(t(answer.other ? "texts.other" : "texts.noname"));
  }

  async function uses() {
    const answer = await asked("references");
    if (!answer) return;
    const { line, column } = editor().about();
    const name = nameAt(
      editor()
        .doc()
        .line(line + 1).text,
      column,
    );
    if (!answer.places.length && !name) refuse(t("texts.noname"));
    const isOwn = level() && /^[LSD$][VA]\d+$/i.test(name); // a variable or array of this program
    if (name) want("uses", isOwn ? `${level()} ${name}` : name);
    list(answer.places.map((/** @type {any} */ each) => ({ ...each, kind: "use" })));
  }

  async function rename() {
    const about = editor().about();
    const name = await asked("renamable", about);
    if (!name) {
      refuse(t("texts.noname"));
      return;
    }
    const word = await askText(t("texts.rename"), t("texts.newname"), name.text);
    const edits = word ? await asked("rename", { ...about, word }) : null;
    if (edits) editor().apply(edits);
    editor().focus();
  }

  async function format() {
    const edits = await asked("formatted");
    if (edits) editor().apply(edits);
  }

  /** @type {(entries: any[], depth?: number) => HTMLElement[]} */
  const entries = (found, depth = 0) =>
    found.flatMap((each) => [
      h(
        "button.key.item",
        { type: "button", onclick: () => editor().goTo([each.line, 0, each.line, 0]), data: { depth: String(depth) } },
        h("span.name", {}, each.name),
        h("span.quiet", {}, each.detail),
      ),
      ...entries(each.parts, depth + 1),
    ]);

  async function outline() {
    const answer = await asked("outline");
    if (answer)
      showBeside(
        h("div.list.text-outline", {}, ...(answer.length ? entries(answer) : [h("p.hint", {}, t("texts.nooutline"))])),
      );
  }

  const keys = { F12: definition, "Shift-F12": uses, F2: rename, "Shift-Alt-f": format };
  return { uses, rename, format, outline, keys };
}
