// Parameters of the card with their live values, by their sections.
import { get } from "../core/api.js";
import { fill, h, setText } from "../core/dom.js";
import { Endings } from "../core/signal.js";
import { needValues } from "../core/values.js";

const MOST = 64; // of one subscription

/**
 * Show what a search finds; returns the function that searches for something else.
 * @param {HTMLElement} host
 * @param {Endings} endings
 * @param {(parameter: any) => boolean} [isMeant]
 */
export function watchTable(host, endings, isMeant = () => true) {
  const own = new Endings();
  endings.add(() => own.end());
  return async (/** @type {Record<string, string | number>} */ query) => {
    const { parameters } = await get("card/parameters", { ...query, count: 500 });
    const shown = parameters.filter(isMeant).slice(0, MOST);
    const values = shown.map(() => h("strong.live", {}, "\u2013"));
    const sections = [...new Set(shown.map((/** @type {any} */ each) => each.section))];
    fill(
      host,
      ...sections.map((section) =>
        h(
          "section.fact-group",
          {},
          h("h3", {}, String(section)),
          h(
            "table.grid",
            {},
            h(
              "tbody",
              {},
              ...shown.map((/** @type {any} */ each, /** @type {number} */ n) =>
                each.section === section ? rowOf(each, values[n]) : "",
              ),
            ),
          ),
        ),
      ),
    );
    own.end();
    own.add(
      needValues(
        shown.map((/** @type {any} */ each) => each.number),
        (known) =>
          shown.forEach((/** @type {any} */ each, /** @type {number} */ n) => {
            const value = known.get(each.number);
            if (value !== undefined) setText(values[n], String(Number(value.toPrecision(9))));
          }),
      ),
    );
  };
}

/**
 * @param {any} parameter
 * @param {HTMLElement} value
 */
function rowOf(parameter, value) {
  return h(
    "tr",
    {},
    h("td", { title: parameter.doc }, parameter.name),
    h("td.quiet.number", {}, `P${parameter.number}`),
    h("td.number", {}, value, parameter.unit ? ` ${parameter.unit}` : ""),
  );
}
