// What the numbers of parameters and flags stand for, after them in the line: shown, no part of the text.
import { h } from "../core/dom.js";
import { Decoration, EditorView, WidgetType } from "../../vendor/codemirror.js";
import { seenLines } from "./seen_lines.js";

class Hint extends WidgetType {
  /** @param {string} text */
  constructor(text) {
    super();
    this.text = text;
  }

  /** @param {Hint} other */
  eq(other) {
    return other.text === this.text;
  }

  toDOM() {
    return h("span.cm-hint", {}, this.text);
  }
}

const LOOKS = EditorView.theme({
  ".cm-hint": {
    color: "var(--quiet)",
    fontSize: "max(12px, 0.85em)",
    padding: "0 0.4em",
    marginLeft: "0.3em",
    border: "1px solid var(--edge)",
    borderRadius: "3px",
  },
});

/** @param {import("./synced.js").SyncedText} text */
export function hints(text) {
  return [
    LOOKS,
    seenLines(text, "hints", ([, column, shown], from) =>
      Decoration.widget({ widget: new Hint(shown), side: 1 }).range(from + column),
    ),
  ];
}
