// Programs, blocks and remarks fold to their first lines, as the server names them.
import { t } from "../core/texts.js";
import {
  EditorState,
  EditorView,
  StateEffect,
  StateField,
  codeFolding,
  foldGutter,
  foldKeymap,
  foldService,
  keymap,
} from "../../vendor/codemirror.js";
import { asking } from "./seen_lines.js";

/**
 * @typedef {import("../../vendor/codemirror.js").Text} Text
 * @typedef {Map<number, { from: number, to: number }>} Folds what folds, by where its first line begins
 */

/** @type {import("../../vendor/codemirror.js").StateEffectType<Folds>} */
const setFolds = StateEffect.define();

/** @type {import("../../vendor/codemirror.js").StateField<Folds>} */
const folds = StateField.define({
  create: () => new Map(),
  update(known, transaction) {
    const answered = transaction.effects.find((effect) => effect.is(setFolds));
    if (answered) return answered.value;
    return transaction.docChanged ? moved(known, transaction.changes, transaction.newDoc) : known;
  },
});

/**
 * What folds after a change, until the server answers.
 * @param {Folds} known
 * @param {import("../../vendor/codemirror.js").ChangeDesc} changes
 * @param {Text} doc
 */
function moved(known, changes, doc) {
  /** @type {Folds} */
  const now = new Map();
  for (const span of known.values()) {
    const [from, to] = [changes.mapPos(span.from, 1), changes.mapPos(span.to, -1)];
    if (to > from) now.set(doc.lineAt(from).from, { from, to });
  }
  return now;
}

/**
 * @param {number[][]} rows first and last line from 0, the longer of two with the same first line later
 * @param {Text} doc
 * @returns {Folds}
 */
const foldsOf = (rows, doc) =>
  new Map(
    rows.map(([first, last]) => {
      const line = doc.line(first + 1);
      return [line.from, { from: line.to, to: doc.line(last + 1).to }];
    }),
  );

const LOOKS = EditorView.theme({
  ".cm-foldGutter .cm-gutterElement": { cursor: "pointer", width: "1.2em", textAlign: "center" },
  ".cm-foldPlaceholder": {
    backgroundColor: "var(--raised)",
    border: "1px solid var(--edge-strong)",
    color: "var(--text)",
    padding: "0 0.5em",
    margin: "0 0.3em",
  },
});

/** @param {import("./synced.js").SyncedText} text */
export function folding(text) {
  /** @param {EditorView} view */
  async function ask(view) {
    const answered = await text.ask("folds");
    if (!answered?.answer || answered.doc !== view.state.doc) return; // the change since then asks again
    view.dispatch({ effects: setFolds.of(foldsOf(answered.answer, answered.doc)) });
  }

  return [
    folds,
    asking(ask, (update) => update.docChanged),
    LOOKS,
    codeFolding(),
    keymap.of(foldKeymap),
    foldService.of((state, lineStart) => state.field(folds).get(lineStart) ?? null),
    foldGutter({ foldingChanged: (update) => update.startState.field(folds) !== update.state.field(folds) }),
    EditorState.phrases.of({
      "Fold line": t("texts.fold"),
      "Unfold line": t("texts.unfold"),
      unfold: t("texts.unfold"),
      "folded code": t("texts.folded"),
      "Folded lines": t("texts.folded"),
      "Unfolded lines": t("texts.unfolded"),
      to: t("texts.foldto"),
    }),
  ];
}
