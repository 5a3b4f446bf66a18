// How the editors look: the colours of the screens.
import { t } from "../core/texts.js";
import { EditorState, EditorView } from "../../vendor/codemirror.js";

export const LOOKS = EditorView.theme({
  "&": { height: "100%", backgroundColor: "var(--sunk)", color: "var(--text)", fontSize: "1rem" },
  ".cm-scroller": { fontFamily: "var(--mono)", lineHeight: "1.5" },
  ".cm-gutters": { backgroundColor: "var(--raised)", color: "var(--quiet)", borderRight: "1px solid var(--edge)" },
  ".cm-activeLine, .cm-activeLineGutter": { backgroundColor: "color-mix(in srgb, var(--accent) 12%, transparent)" },
  ".cm-cursor": { borderLeftColor: "var(--text)", borderLeftWidth: "2px" },
  "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": {
    backgroundColor: "color-mix(in srgb, var(--accent) 35%, transparent)",
  },
  ".cm-panels": { backgroundColor: "var(--raised)", color: "var(--text)" },
  ".cm-panel.cm-search": {
    display: "flex",
    flexWrap: "wrap",
    alignItems: "center",
    gap: "4px",
    padding: "4px 2.4em 4px 4px",
    fontFamily: "inherit",
  },
  ".cm-panel.cm-search br": { display: "none" },
  ".cm-panel.cm-search :is(.cm-textfield, .cm-button)": {
    minHeight: "var(--target)",
    margin: "0",
    padding: "0 0.7em",
    border: "1px solid var(--edge-strong)",
    borderRadius: "var(--round)",
    background: "var(--raised)",
    color: "var(--text)",
    fontSize: "0.9rem",
    fontWeight: "600",
  },
  ".cm-panel.cm-search .cm-textfield": {
    background: "var(--sunk)",
    fontFamily: "var(--mono)",
    fontWeight: "400",
    minWidth: "9em",
    flex: "1",
  },
  ".cm-panel.cm-search label": {
    display: "inline-flex",
    alignItems: "center",
    gap: "0.3em",
    margin: "0",
    fontSize: "0.85rem",
  },
  ".cm-panel.cm-search [name=close]": {
    position: "absolute",
    top: "4px",
    right: "4px",
    minWidth: "2em",
    minHeight: "var(--target)",
    fontSize: "1.2rem",
    color: "var(--text)",
  },
  ".cm-tooltip-autocomplete.cm-tooltip > ul": { maxHeight: "10em", fontFamily: "var(--mono)" },
  ".cm-tooltip": { backgroundColor: "var(--pane)", color: "var(--text)", border: "1px solid var(--edge-strong)" },
});

/** The words of the find panel in the language of the screens. */
export function findTexts() {
  return EditorState.phrases.of({
    Find: t("find.find"),
    Replace: t("find.by"),
    next: t("find.next"),
    previous: t("find.previous"),
    all: t("find.all"),
    "match case": t("find.case"),
    regexp: t("find.regexp"),
    "by word": t("find.word"),
    replace: t("find.replace"),
    "replace all": t("find.replaceall"),
    close: t("key.close"),
    "current match": t("find.current"),
    "on line": t("find.online"),
    "replaced match on line $": t("find.replaced"),
    "replaced $ matches": t("find.replacedall"),
    "Go to line": t("find.goto"),
    go: t("find.go"),
  });
}
