// What the names of a line are worth, after its end: drawn over the ground, so that no line becomes longer.
import { h } from "../core/dom.js";
import { Decoration, EditorView, StateEffect, StateField, WidgetType } from "../../vendor/codemirror.js";
import { asking } from "./seen_lines.js";

const NARROWEST = 80; // pixels
const MARK = "7.5em"; // room for what marks the line at its right edge

/**
 * @typedef {{ program: string, names: [string, string][] }} Named what a line of a program names, as it is written and
 *   as the card knows it
 * @typedef {(named: Named) => { text: string, all: string } | null} Say what is shown of a line, and all of it
 */

const LOOKS = EditorView.theme({
  ".cm-values": {
    position: "absolute",
    marginLeft: "1.6em",
    minHeight: "1px", // without values, too: nothing is scrolled otherwise than with them
    overflow: "hidden",
    textOverflow: "ellipsis",
    whiteSpace: "pre",
    color: "var(--accent)",
    fontSize: "max(12px, 0.9em)",
    cursor: "default",
    pointerEvents: "none",
  },
  ".cm-values::after": { content: "attr(data-values)", pointerEvents: "auto" }, // no text of the document
});

class Values extends WidgetType {
  /**
   * @param {Named} named
   * @param {Map<HTMLElement, Named>} shown
   */
  constructor(named, shown) {
    super();
    this.named = named;
    this.key = JSON.stringify(named);
    this.shown = shown;
  }

  /** @param {Values} other */
  eq(other) {
    return other.key === this.key;
  }

  toDOM() {
    const element = h("span.cm-values", { ariaHidden: "true" });
    this.shown.set(element, this.named);
    return element;
  }

  /** @param {HTMLElement} element */
  destroy(element) {
    this.shown.delete(element);
  }

  ignoreEvent() {
    return false; // a press puts the cursor into the line
  }
}

/**
 * @param {import("./synced.js").SyncedText} text
 * @param {(seen: Named[]) => void} seen what the lines in view name has changed
 */
export function lineValues(text, seen) {
  /** @type {Map<HTMLElement, Named>} */
  const shown = new Map();
  /** @type {Say} */
  let say = () => null;
  /** @type {import("../../vendor/codemirror.js").StateEffectType<import("../../vendor/codemirror.js").DecorationSet>} */
  const replace = StateEffect.define();
  const field = StateField.define({
    create: () => Decoration.none,
    update(now, transaction) {
      const set = transaction.effects.find((each) => each.is(replace));
      return set ? set.value : now.map(transaction.changes);
    },
    provide: (its) => EditorView.decorations.from(its),
  });

  /** @param {EditorView} view */
  async function ask(view) {
    const { doc } = view.state;
    const [first, last] = [view.viewport.from, view.viewport.to].map((at) => doc.lineAt(at).number);
    const answered = await text.ask("values", { line: first - 1, last: last - 1 });
    if (!answered?.answer || answered.doc !== view.state.doc) return; // the change since then asks again
    /** @type {[number, string, [string, string][]][]} */
    const rows = answered.answer;
    const set = Decoration.set(
      rows.map(([line, program, names]) =>
        Decoration.widget({ widget: new Values({ program, names }, shown), side: 2 }).range(doc.line(line + 1).to),
      ),
    );
    view.dispatch({ effects: replace.of(set) });
    seen(rows.map(([, program, names]) => ({ program, names })));
    fit(view);
    draw();
  }

  /** The room of values is the rest of the line, whatever they are: none makes the text wider. @param {EditorView} view */
  function fit(view) {
    view.requestMeasure({
      key: shown,
      read: () => {
        const { right } = view.scrollDOM.getBoundingClientRect();
        return [...shown.keys()].map(
          (each) => /** @type {const} */ ([each, right - each.getBoundingClientRect().left]),
        );
      },
      write: (rooms) => {
        for (const [each, room] of rooms)
          each.style.width = `calc(max(${NARROWEST}px, ${Math.floor(room)}px - ${MARK}))`;
      },
    });
  }

  function draw() {
    for (const [element, named] of shown) {
      const said = say(named);
      const [values, title] = [said?.text ?? "", said?.all ?? ""];
      if (element.dataset.values !== values) element.dataset.values = values;
      if (element.title !== title) element.title = title;
    }
  }

  return {
    extension: [
      LOOKS,
      field,
      asking(ask, (update) => update.docChanged || update.viewportChanged),
      EditorView.updateListener.of((update) => fit(update.view)), // a hint makes its line longer
    ],
    /** Show values as they are now. @param {Say} what */
    show(what) {
      say = what;
      draw();
    },
  };
}
