// The editor of controller files: CodeMirror in a shadow root, with what the server knows of the language.
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import {
  EditorState,
  EditorView,
  defaultKeymap,
  drawSelection,
  forceLinting,
  highlightActiveLine,
  highlightActiveLineGutter,
  history,
  historyKeymap,
  keymap,
  lineNumbers,
  search,
  searchKeymap,
  tooltips,
} from "../../vendor/codemirror.js";
import { applyEdits, language } from "./language.js";
import { lineValues } from "./line_values.js";
import { lineMarks, setLineMarks } from "./line_marks.js";
import { LOOKS, findTexts } from "./looks.js";
import { SyncedText, offsetsOf, placeOf } from "./synced.js";

const ABOUT = EditorView.theme({
  ".about": { maxWidth: "38em", maxHeight: "16em", overflow: "auto", padding: "0.3em 0.7em", whiteSpace: "normal" },
  ".about p, .about ul": { margin: "0.4em 0" },
  ".cm-lineNumbers .cm-gutterElement": { cursor: "pointer" },
});

/**
 * @typedef {object} Options
 * @property {string} name of the file; prog3.8k and plc0.8k are programs of the card
 * @property {string} setup what the program finds on the card, as set-up code
 * @property {string} text
 * @property {(findings: import("./language.js").Finding[], more: number) => void} found
 * @property {(changes: import("../../vendor/codemirror.js").ChangeSet) => void} changed
 * @property {() => void} moved the cursor
 * @property {Record<string, () => void>} keys
 * @property {(seen: import("./line_values.js").Named[]) => void} named what the lines in view name has changed
 * @property {(line: number, isRight: boolean) => void} lineChosen a line number was pressed, from 1
 *
 * @param {HTMLElement} host
 * @param {Options} options
 */
export function createControllerEditor(host, { name, setup, text, found, changed, moved, keys, named, lineChosen }) {
  const place = h("div.editor", {});
  host.replaceChildren(place);
  const root = place.attachShadow({ mode: "open" });
  const own = Object.entries(keys).map(([key, does]) => ({
    key,
    preventDefault: true,
    run: () => {
      does();
      return true;
    },
  }));
  const pressed = (/** @type {boolean} */ isRight) => (/** @type {EditorView} */ its, /** @type {any} */ block) => {
    lineChosen(its.state.doc.lineAt(block.from).number, isRight);
    return isRight;
  };
  const state = EditorState.create({ doc: text });
  const synced = new SyncedText(name, setup, state.doc);
  const values = lineValues(synced, named);
  const view = new EditorView({
    root,
    parent: root,
    state: EditorState.create({
      doc: state.doc,
      extensions: [
        lineNumbers({ domEventHandlers: { click: pressed(false), contextmenu: pressed(true) } }),
        history(),
        drawSelection(),
        highlightActiveLine(),
        highlightActiveLineGutter(),
        search({ top: true }),
        LOOKS,
        ABOUT,
        tooltips({ position: "absolute", tooltipSpace: () => host.getBoundingClientRect() }),
        findTexts(),
        EditorView.updateListener.of((update) => {
          if (update.docChanged) {
            synced.changed(update.changes, update.state.doc);
            changed(update.changes);
          }
          if (update.docChanged || update.selectionSet) moved();
        }),
        language(synced, found),
        lineMarks,
        values.extension,
        keymap.of([...own, ...defaultKeymap, ...historyKeymap, ...searchKeymap]),
        EditorView.contentAttributes.of({
          "aria-label": t("texts.text"),
          spellcheck: "false",
          autocapitalize: "characters",
        }),
      ],
    }),
  });
  forceLinting(view);

  /** The place of the cursor, for questions. */
  function about() {
    const [line, column] = placeOf(view.state.doc, view.state.selection.main.head);
    return { line, column };
  }

  return {
    synced,
    about,
    text: () => view.state.doc.toString(),
    doc: () => view.state.doc,
    focus: () => view.focus(),
    close() {
      synced.end();
      view.destroy();
    },
    /** @param {any[][]} edits */
    apply: (edits) => applyEdits(view, edits),
    showValues: values.show,
    /** @param {import("./line_marks.js").LineMark[]} marks */
    mark: (marks) => view.dispatch({ effects: setLineMarks.of(marks) }),
    /**
     * Bring a place into view.
     * @param {number} at
     */
    see: (at) => view.dispatch({ effects: EditorView.scrollIntoView(at, { y: "center" }) }),
    /** @param {number[]} span from line and column to line and column, from 0 */
    goTo(span) {
      view.dispatch({ selection: { anchor: offsetsOf(view.state.doc, span).from }, scrollIntoView: true });
      view.focus();
    },
  };
}
