// The editor of part programs: CodeMirror in a shadow root, where its styles need no exception of the policy.
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import {
  Compartment,
  EditorState,
  EditorView,
  HighlightStyle,
  defaultKeymap,
  drawSelection,
  forceLinting,
  highlightActiveLine,
  highlightActiveLineGutter,
  history,
  historyKeymap,
  keymap,
  lineNumbers,
  lintGutter,
  linter,
  search,
  searchKeymap,
  syntaxHighlighting,
  tags,
} from "../../vendor/codemirror.js";
import { gcode } from "./gcode.js";
import { LOOKS, findTexts } from "./looks.js";

const CHECK_MS = 400;
const MOST_CHECKED = 1 << 20; // characters

const COLORS = HighlightStyle.define([
  { tag: tags.comment, color: "var(--quiet)", fontStyle: "italic" },
  { tag: tags.keyword, color: "var(--accent)", fontWeight: "700" },
  { tag: tags.typeName, color: "var(--warn)", fontWeight: "700" },
  { tag: tags.controlKeyword, color: "var(--bad)", fontWeight: "700" },
  { tag: tags.standard(tags.function(tags.variableName)), color: "var(--bad)" },
  { tag: tags.attributeName, color: "var(--good)", fontWeight: "600" },
  { tag: tags.propertyName, color: "var(--text)", fontWeight: "700" },
  { tag: tags.labelName, color: "var(--quiet)" },
  { tag: tags.variableName, color: "var(--good)" },
  { tag: tags.string, color: "var(--good)" },
]);

/**
 * @typedef {import("../frame/findings.js").Finding} Finding
 *
 * @param {HTMLElement} host
 * @param {{ check: (text: string) => Promise<Finding[]>, found: (findings: Finding[]) => void,
 *   changed: () => void }} options
 */
export function createEditor(host, { check, found, changed }) {
  const place = h("div.editor", {});
  host.append(place);
  const root = place.attachShadow({ mode: "open" });
  const readOnly = new Compartment();
  let isReadOnly = false;
  const findings = linter(
    async (view) => {
      const doc = view.state.doc;
      const list = doc.length > MOST_CHECKED ? [] : await check(doc.toString());
      if (view.state.doc !== doc) return []; // of an older text: its answer may even come after that of the new one
      found(list);
      return list
        .filter((each) => each.line >= 1 && each.line <= view.state.doc.lines)
        .map((each) => {
          const line = view.state.doc.line(each.line);
          const from = Math.min(line.to, line.from + Math.max(0, each.column - 1));
          return {
            from,
            to: Math.min(line.to, from + 1),
            severity: each.severity,
            message: `${each.code} ${each.text}`,
          };
        });
    },
    { delay: CHECK_MS },
  );
  const extensions = [
    lineNumbers(),
    lintGutter(),
    history(),
    drawSelection(),
    highlightActiveLine(),
    highlightActiveLineGutter(),
    search({ top: true }),
    findTexts(),
    gcode,
    syntaxHighlighting(COLORS),
    LOOKS,
    findings,
    keymap.of([...defaultKeymap, ...historyKeymap, ...searchKeymap]),
    readOnly.of(EditorState.readOnly.of(false)),
    EditorView.updateListener.of((update) => update.docChanged && changed()),
    EditorView.contentAttributes.of({
      "aria-label": t("edit.text"),
      spellcheck: "false",
      autocapitalize: "characters",
    }),
  ];
  const view = new EditorView({ root, parent: root, state: EditorState.create({ extensions }) });
  return {
    text: () => view.state.doc.toString(),
    lines: () => view.state.doc.lines,
    focus: () => view.focus(),
    close: () => view.destroy(),
    /** @param {string} text */
    setText(text) {
      view.setState(EditorState.create({ doc: text, extensions }));
      forceLinting(view);
    },
    /** @param {boolean} on */
    setReadOnly(on) {
      if (on === isReadOnly) return;
      isReadOnly = on;
      view.dispatch({ effects: readOnly.reconfigure(EditorState.readOnly.of(on)) });
    },
    /**
     * @param {number} line
     * @param {number} column
     */
    goTo(line, column) {
      const at = view.state.doc.line(Math.min(Math.max(1, line), view.state.doc.lines));
      view.dispatch({
        selection: { anchor: Math.min(at.to, at.from + Math.max(0, column - 1)) },
        scrollIntoView: true,
      });
      view.focus();
    },
  };
}
