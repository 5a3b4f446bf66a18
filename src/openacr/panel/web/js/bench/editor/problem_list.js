// The list below the text: findings and places, each leads to its place, a finding to what mends it.
import { fill, h } from "../../core/dom.js";
import { t } from "../../core/texts.js";

const TEXTS = { findings: { en: "Findings and places", de: "Befunde und Stellen" } };

/** @param {{ goTo: (span: number[]) => void, apply: (edits: any[][]) => void }} editor */
export function problemList({ goTo, apply }) {
  const problems = h("div.findings.scroll", { hidden: true, role: "region", ariaLabel: t(TEXTS.findings) });

  /** @param {import("./name_actions.js").Item[]} items */
  function list(items) {
    problems.hidden = items.length === 0;
    fill(problems, ...items.map(rowOf));
  }

  /** @param {import("./name_actions.js").Item} item */
  function rowOf({ span, text, kind, fix }) {
    return h(
      "div.row",
      {},
      h(
        "button",
        { type: "button", className: `key item grow ${kind}`, onclick: () => goTo(span) },
        h("span", {}, kind === "error" ? "\u26a0" : "\u2139"),
        h("span.number", {}, `${span[0] + 1}:${span[1] + 1}`),
        h("span.name", {}, text),
      ),
      ...(fix ? [h("button.key", { type: "button", onclick: () => apply(fix.edits) }, fix.title)] : []),
    );
  }

  return { problems, list };
}
