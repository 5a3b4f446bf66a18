// A text beside what the card lists: differences with the lines around them.
import { h } from "../../core/dom.js";
import { t } from "../../core/texts.js";

const AROUND = 3; // equal lines above and below a difference

/**
 * @typedef {[number, string, number, string, boolean]} Row line and text here, number and text on the card, whether
 *   they mean the same
 * @typedef {{ name: string, rows: Row[], is_equal: boolean }} Compared
 *
 * @param {Compared} compared
 * @param {(line: number) => void} chosen a line of the text, from 1
 * @param {string} [here] what the text is
 */
export function comparison({ name, rows, is_equal }, chosen, here = t("texts.here")) {
  const shown = rows.map((_row, n) => rows.slice(Math.max(0, n - AROUND), n + AROUND + 1).some((each) => !each[4]));
  /** @type {HTMLElement[]} */
  const body = [];
  let skipped = 0;
  const skip = () => {
    if (skipped) body.push(h("tr", {}, h("td.quiet", { colSpan: 4 }, t("texts.equal.lines", { count: skipped }))));
    skipped = 0;
  };
  rows.forEach(([line, text, number, listed, isSame], n) => {
    if (!shown[n]) {
      skipped += 1;
      return;
    }
    skip();
    body.push(
      h(
        "tr",
        { className: isSame ? "" : "is-different", onclick: () => line && chosen(line) },
        h("td.number.quiet", {}, line || ""),
        h("td.mono", {}, text),
        h("td.number.quiet", {}, number || ""),
        h("td.mono", {}, listed),
      ),
    );
  });
  skip();
  return h(
    "table.grid.compared",
    { ariaLabel: t("texts.compared", { name }) },
    h("caption", {}, name, " \u00b7 ", t(is_equal ? "texts.same" : "texts.different")),
    h("thead", {}, h("tr", {}, h("th", { colSpan: 2 }, here), h("th", { colSpan: 2 }, t("texts.oncard")))),
    h("tbody", {}, ...body),
  );
}
