// LIBRARY PART: a form for the sizes of a part, and its picture while they are typed.
import { get } from "../core/api.js";
import { refuse } from "../core/app.js";
import { numberIn } from "../core/arithmetic.js";
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { fetchPath } from "../draw/path.js";
import { createPicture } from "../draw/picture.js";

const WAIT_MS = 250;
const MM_PER_INCH = 25.4;
const TOOL_RADIUS = 224; // its cell
/** @type {Record<string, string>} */
const SIGNS = { "*": " \u00d7 ", "/": " \u00f7 ", "-": " \u2212 ", "+": " + ", "<=": "\u2264", ">=": "\u2265" };

/**
 * @param {HTMLElement} host
 * @param {import("../core/signal.js").Endings} endings
 * @param {import("./files.js").Load} load
 */
export async function partSource(host, endings, load) {
  const list = h("div.list.scroll.part-list", { role: "listbox", ariaLabel: t("load.part") });
  const form = h("div.part-form.scroll", {});
  const drawing = h("div.preview.grow", {});
  const go = h("button.key.main.big", { type: "button", disabled: true }, t("load.go"));
  const conditions = h("div.hint.grow", {});
  host.append(
    h("div.load-parts", {}, list, form, h("div.stack.load-side", {}, drawing, h("div.row", {}, conditions, go))),
  );
  const picture = await createPicture(drawing, endings);
  const { parts, metric } = await get("parts").catch((error) => {
    refuse(error);
    return { parts: [], metric: false };
  });
  let turn = new AbortController();
  endings.add(() => turn.abort());
  const choose = (/** @type {any} */ part) => {
    for (const key of list.children)
      key.setAttribute("aria-selected", String(/** @type {HTMLElement} */ (key).dataset.part === part.name));
    const sizes = part.sizes.map((/** @type {any} */ size) => shownIn(size, metric));
    const fields = sizes.map((/** @type {any} */ each) => ({
      each,
      input: h("input.field.number", {
        id: `part-P${each.cell}`,
        value: String(each.default ?? ""),
        inputMode: "decimal",
        autocomplete: "off",
      }),
    }));
    const values = () =>
      Object.fromEntries(
        fields.flatMap((/** @type {any} */ { each, input }) => {
          const value = numberIn(input, each.text);
          return value === null ? [] : [[`P${each.cell}`, value / each.scale]];
        }),
      );
    fill(
      form,
      h("h3", {}, part.title || part.name),
      ...fields.map((/** @type {any} */ { each, input }) =>
        h(
          "div.form-row",
          {},
          h("label", { htmlFor: input.id }, each.text),
          h("div.row.form-input", {}, input, each.unit ? h("span.unit", {}, each.unit) : ""),
          h("span.hint", {}, `P${each.cell} \u00b7 ${rangeOf(each)}`),
        ),
      ),
    );
    fill(
      conditions,
      [part.start, ...part.checks.map((/** @type {string} */ rule) => inWords(rule, part.sizes))]
        .filter(Boolean)
        .join(" \u00b7 "),
    );
    let timer = setTimeout(() => {}, 0);
    const draw = async () => {
      turn.abort();
      const mine = (turn = new AbortController());
      try {
        const body = JSON.stringify({ values: values(), tool: 0 });
        picture.setPath(
          await fetchPath(
            `parts/${part.name}/path`,
            {},
            { method: "POST", headers: { "Content-Type": "application/json" }, body, signal: mine.signal },
          ),
        );
      } catch (error) {
        if (!mine.signal.aborted) refuse(error);
      }
    };
    for (const { input } of fields)
      input.addEventListener("input", () => {
        clearTimeout(timer);
        timer = setTimeout(draw, WAIT_MS);
      });
    go.disabled = false;
    go.onclick = () => {
      try {
        void load("program.part", { part: part.name, values: values() });
      } catch (error) {
        refuse(error); // not a number
      }
    };
    void draw();
  };
  fill(
    list,
    ...parts.map((/** @type {any} */ part) =>
      h(
        "button.key.item",
        {
          type: "button",
          role: "option",
          ariaSelected: "false",
          data: { part: part.name },
          onclick: () => choose(part),
        },
        h("strong", {}, part.name),
        h("span.name", {}, part.title),
      ),
    ),
  );
  if (parts.length) choose(parts[0]);
}

/**
 * A size in the unit of the machine; `scale` times its own one is what is shown.
 * @param {any} size
 * @param {boolean} isMetric
 */
function shownIn(size, isMetric) {
  const [scale, unit] =
    size.unit === "in" && isMetric
      ? [MM_PER_INCH, "mm"]
      : size.unit === "mm" && !isMetric
        ? [1 / MM_PER_INCH, "in"]
        : [1, size.unit];
  const shown = (/** @type {number} */ value) => Number((value * scale).toPrecision(6));
  return {
    ...size,
    unit: unit === "n" ? "" : unit,
    scale,
    default: shown(size.default),
    low: shown(size.low),
    high: shown(size.high),
  };
}

/**
 * A condition between sizes with their names.
 * @param {string} rule
 * @param {{ cell: number, text: string }[]} sizes
 */
function inWords(rule, sizes) {
  return rule
    .replaceAll("/57.29578", ` ${t("load.radians")}`)
    .replace(/P(\d+)|<=|>=|[*/+-]|\bOR\b|\bAND\b/g, (found, cell) => {
      if (!cell) return SIGNS[found] ?? t(found === "OR" ? "load.or" : "load.and");
      if (Number(cell) === TOOL_RADIUS) return t("load.radius");
      const size = sizes.find((each) => each.cell === Number(cell));
      return size ? `\u201c${size.text}\u201d` : found;
    });
}

/** @param {{ low: number, high: number }} size */
function rangeOf({ low, high }) {
  return t("field.range", { low, high });
}
