// Lines that run, are stopped before, have a breakpoint or were refused: marks stay at their lines while the text is
// changed.
import { Decoration, EditorView, StateEffect, StateField } from "../../vendor/codemirror.js";

/**
 * @typedef {{ at: number, kind: "running" | "held" | "break" | "refused", text: string }} LineMark
 * @type {import("../../vendor/codemirror.js").StateEffectType<LineMark[]>}
 */
export const setLineMarks = StateEffect.define();

const LOOKS = EditorView.theme({
  ".cm-line": { paddingLeft: "1.3em" }, // room for the sign of a breakpoint
  ".cm-line-break": { position: "relative" },
  ".cm-line-break::before": {
    content: '""',
    position: "absolute",
    left: "0.35em",
    top: "0.4em",
    width: "0.7em",
    height: "0.7em",
    borderRadius: "50%",
    backgroundColor: "var(--bad)",
  },
  ".cm-line-held": {
    position: "relative",
    backgroundColor: "var(--warn-ground)",
    boxShadow: "inset 4px 0 0 var(--warn)",
  },
  ".cm-line-held::after": {
    content: '"\\25A0 " attr(data-mark)',
    position: "absolute",
    right: "0",
    top: "0",
    padding: "0 0.4em",
    backgroundColor: "var(--warn-ground)",
    color: "var(--warn)",
    fontWeight: "700",
  },
  ".cm-line-running": {
    position: "relative",
    backgroundColor: "var(--good-ground)",
    boxShadow: "inset 4px 0 0 var(--good)",
  },
  ".cm-line-running::after": {
    content: '"\\25C0 " attr(data-mark)',
    position: "absolute",
    right: "0",
    top: "0",
    padding: "0 0.4em",
    backgroundColor: "var(--good-ground)",
    color: "var(--good)",
    fontWeight: "700",
  }, // beside the text: no line becomes longer
  ".cm-line-refused": { backgroundColor: "var(--bad-ground)", boxShadow: "inset 4px 0 0 var(--bad)" },
  ".cm-line-refused::after": { content: '"  \\26A0 " attr(data-mark)', color: "var(--bad)", fontWeight: "700" },
});

const field = StateField.define({
  create: () => Decoration.none,
  update(shown, transaction) {
    let now = shown.map(transaction.changes);
    for (const effect of transaction.effects) {
      if (!effect.is(setLineMarks)) continue;
      const { doc } = transaction.state;
      now = Decoration.set(
        effect.value.map(({ at, kind, text }) =>
          Decoration.line({
            class: `cm-line-${kind}`,
            attributes: kind === "break" ? { title: text } : { "data-mark": text },
          }).range(doc.lineAt(Math.min(at, doc.length)).from),
        ),
        true,
      );
    }
    return now;
  },
  provide: (its) => EditorView.decorations.from(its),
});

export const lineMarks = [field, LOOKS];

/** The lines that the card stores of a text, by program and number, as the text had them when it was the card's. */
export class StoredLines {
  /**
   * @param {Record<string, [number, number][]>} programs number on the card and line from 0
   * @param {import("../../vendor/codemirror.js").Text} doc
   */
  constructor(programs, doc) {
    this.doc = doc;
    /** @type {import("../../vendor/codemirror.js").ChangeSet | null} */
    this.since = null;
    this.places = new Map(Object.entries(programs).map(([name, lines]) => [name, new Map(lines)]));
  }

  /** @param {import("../../vendor/codemirror.js").ChangeSet} changes */
  changed(changes) {
    this.since = this.since ? this.since.compose(changes) : changes;
  }

  /**
   * Where a line of a program is in the present text.
   * @param {string} name
   * @param {number} number
   * @returns {number | null}
   */
  at(name, number) {
    const line = this.places.get(name)?.get(number);
    if (line === undefined) return null;
    const from = this.doc.line(line + 1).from;
    return this.since ? this.since.mapPos(from, 1) : from;
  }

  /**
   * The program and number of a line of the present text, from 1; null where the card has none there.
   * @param {import("../../vendor/codemirror.js").Text} doc the present text
   * @param {number} line
   */
  numberAt(doc, line) {
    const { from } = doc.line(line);
    for (const [name, numbers] of this.places)
      for (const number of numbers.keys()) if (this.at(name, number) === from) return { name, number };
    return null;
  }
}
