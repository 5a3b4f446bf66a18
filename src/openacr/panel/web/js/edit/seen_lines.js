// What the server says of the lines that are seen, drawn in them: asked again when the text changes or others come into
// view.
import { EditorView, StateEffect, StateField, ViewPlugin, Decoration } from "../../vendor/codemirror.js";

const SOON_MS = 60;
const BEYOND = 40; // lines above and below what is seen

/**
 * @param {import("./synced.js").SyncedText} text
 * @param {string} question its answer has rows that begin with a line
 * @param {(row: any[], from: number) => import("../../vendor/codemirror.js").Range<Decoration>} drawn a row of it; its
 *   line begins at `from`
 */
export function seenLines(text, question, drawn) {
  /** @type {import("../../vendor/codemirror.js").StateEffectType<{ from: number, to: number, marks: any[] }>} */
  const replace = StateEffect.define();
  const field = StateField.define({
    create: () => Decoration.none,
    update(shown, transaction) {
      let now = shown.map(transaction.changes);
      for (const effect of transaction.effects) {
        if (!effect.is(replace)) continue;
        const { from, to, marks } = effect.value;
        now = now.update({ filterFrom: from, filterTo: to, filter: () => false, add: marks, sort: true });
      }
      return now;
    },
    provide: (its) => EditorView.decorations.from(its),
  });

  /** @param {EditorView} view */
  async function draw(view) {
    const { doc } = view.state;
    const first = Math.max(1, doc.lineAt(view.viewport.from).number - BEYOND);
    const last = Math.min(doc.lines, doc.lineAt(view.viewport.to).number + BEYOND);
    const answered = await text.ask(question, { line: first - 1, last: last - 1 });
    if (!answered?.answer || answered.doc !== view.state.doc) return; // the change since then asks again
    const marks = answered.answer.map((/** @type {any[]} */ row) => drawn(row, doc.line(row[0] + 1).from));
    view.dispatch({ effects: replace.of({ from: doc.line(first).from, to: doc.line(last).to, marks }) });
  }

  return [field, asking(draw, (update) => update.docChanged || update.viewportChanged)];
}

/**
 * Ask at the beginning and soon after each change that counts.
 * @param {(view: EditorView) => Promise<void>} ask
 * @param {(update: import("../../vendor/codemirror.js").ViewUpdate) => boolean} counts
 */
export function asking(ask, counts) {
  return ViewPlugin.define((view) => {
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    let timer;
    const soon = () => {
      clearTimeout(timer);
      timer = setTimeout(() => void ask(view), SOON_MS);
    };
    soon();
    return {
      update(update) {
        if (counts(update)) soon();
      },
      destroy: () => clearTimeout(timer),
    };
  });
}
