// What a controller file looks like while it is typed: colours, folds, hints, findings, completion and hover, as the
// server answers.
import {
  Decoration,
  EditorView,
  autocompletion,
  completionKeymap,
  hoverTooltip,
  keymap,
  lintGutter,
  linter,
} from "../../vendor/codemirror.js";
import { folding } from "./folding.js";
import { hints } from "./hints.js";
import { markdown } from "./markdown.js";
import { seenLines } from "./seen_lines.js";
import { offsetsOf, placeOf } from "./synced.js";

const CHECK_MS = 400;

/**
 * @typedef {import("./synced.js").SyncedText} SyncedText
 * @typedef {{ span: number[], text: string, is_warning: boolean, fix: { title: string, edits: any[] } | null }} Finding
 */

const COLORS = EditorView.theme({
  ".tok-command, .tok-keyword": { color: "var(--accent)", fontWeight: "700" },
  ".tok-function": { color: "var(--bad)" },
  ".tok-parameter, .tok-flag, .tok-variable": { color: "var(--good)" },
  ".tok-axis": { color: "var(--text)", fontWeight: "700" },
  ".tok-alias, .tok-label": { color: "var(--warn)", fontWeight: "700" },
  ".tok-string": { color: "var(--good)", fontStyle: "italic" },
  ".tok-remark": { color: "var(--quiet)", fontStyle: "italic" },
});

/**
 * Apply changes as the server names them.
 * @param {EditorView} view
 * @param {any[][]} edits line and column, line and column, text
 */
export function applyEdits(view, edits) {
  const changes = edits.map(([a, b, c, d, insert]) => ({ ...offsetsOf(view.state.doc, [a, b, c, d]), insert }));
  view.dispatch({ changes, userEvent: "input" });
}

/**
 * @param {SyncedText} text
 * @param {(findings: Finding[], more: number) => void} found
 */
export function language(text, found) {
  /** @param {import("../../vendor/codemirror.js").CompletionContext} context */
  async function complete(context) {
    if (!context.explicit && !context.matchBefore(/[\w#$<]$/)) return null;
    const { doc } = context.state;
    const [line, column] = placeOf(doc, context.pos);
    const answered = await text.ask("complete", { line, column });
    if (!answered?.answer || answered.doc !== doc || !answered.answer.items.length) return null;
    const span = offsetsOf(doc, answered.answer.span);
    return {
      ...span,
      filter: false,
      options: answered.answer.items.map((/** @type {any} */ each) => ({
        label: each.label,
        detail: each.detail,
        apply: each.text,
        info: each.doc ? () => markdown(each.doc) : undefined,
      })),
    };
  }

  /**
   * @param {EditorView} view
   * @param {number} at
   */
  async function hover(view, at) {
    const [line, column] = placeOf(view.state.doc, at);
    const answered = await text.ask("hover", { line, column });
    if (!answered?.answer || answered.doc !== view.state.doc) return null;
    const { from, to } = offsetsOf(answered.doc, answered.answer.span);
    return { pos: from, end: to, create: () => ({ dom: markdown(answered.answer.text) }) };
  }

  /** @param {EditorView} view */
  async function check(view) {
    const { doc } = view.state;
    const answered = doc.toString().trim() ? await text.ask("findings") : { answer: { findings: [], more: 0 }, doc };
    if (!answered?.answer || answered.doc !== view.state.doc) return [];
    /** @type {{ findings: Finding[], more: number }} */
    const { findings, more } = answered.answer;
    found(findings, more);
    return findings.map(({ span, text: message, is_warning, fix }) => ({
      ...offsetsOf(doc, span),
      severity: /** @type {"warning" | "error"} */ (is_warning ? "warning" : "error"),
      message,
      actions: fix ? [{ name: fix.title, apply: (/** @type {EditorView} */ its) => applyEdits(its, fix.edits) }] : [],
    }));
  }

  const colors = seenLines(text, "colors", ([, start, end, kind], from) =>
    Decoration.mark({ class: `tok-${kind}` }).range(from + start, from + end),
  );
  return [
    colors,
    COLORS,
    lintGutter(),
    folding(text),
    hints(text),
    linter(check, { delay: CHECK_MS }),
    hoverTooltip(hover),
    autocompletion({ override: [complete], icons: false }),
    keymap.of(completionKeymap),
  ];
}
