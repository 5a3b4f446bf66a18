// The branches of the timeline: lanes over the shown time, one click changes to another, and a table of what is done with them.
import { give } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { ask } from "../frame/dialog.js";
import { placeOf } from "./time_view.js";

const TEXTS = {
  branches: { en: "Branch", de: "Zweig" },
  from: { en: "from s", de: "von s" },
  to: { en: "to s", de: "bis s" },
  do: { en: "Keys", de: "Tasten" },
  name: { en: "NAME", de: "NAME" },
  switch: { en: "CHANGE TO", de: "WECHSELN" },
  forget: { en: "FORGET", de: "VERGESSEN" },
  show: { en: "Change to {name}", de: "Zu {name} wechseln" },
  compare: {
    en: "Draw the lanes of {name} below those of this branch",
    de: "Spuren von {name} unter denen dieses Zweigs zeichnen",
  },
  first: { en: "Go to the first difference from {name} (F)", de: "Zum ersten Unterschied zu {name} (F)" },
};

/**
 * @typedef {import("../core/model.js").TimeBranch} TimeBranch
 * @typedef {import("./time_view.js").Part} Part
 */

/**
 * @param {{ seconds: (tick: number) => string, compare: (branch: number) => void,
 *   first: (branch: number) => void }} asked
 */
export function createBranches({ seconds, compare, first }) {
  const rows = h("tbody", {});
  const heads = [TEXTS.branches, TEXTS.from, TEXTS.to, TEXTS.do];
  const table = h("table.grid", {}, h("thead", {}, h("tr", {}, ...heads.map((each) => h("th", {}, t(each))))), rows);
  const lanes = h("div.time-branches", {});

  /** @param {TimeBranch} branch */
  async function rename(branch) {
    const field = h("input.field", { value: branch.name, maxLength: 80, ariaLabel: t(TEXTS.name) });
    const name = await ask({
      title: t(TEXTS.name),
      body: [field],
      first: field,
      choices: [
        { text: t(TEXTS.name), kind: "main", isSubmit: true, value: () => field.value.trim() || undefined },
        { text: t("key.cancel"), value: null },
      ],
    });
    if (name) await give("timeline.name", { number: branch.number, name });
  }

  /** @param {number} number */
  const change = (number) => void give("timeline.switch", { number });

  /** @param {TimeBranch} branch @param {number | null} compared */
  function keysOf({ number, name }, compared) {
    const key = (
      /** @type {"compare" | "first"} */ what,
      /** @type {string} */ sign,
      /** @type {(number: number) => void} */ does,
      /** @type {string | null} */ ariaPressed,
    ) =>
      h(
        "button.time-compare",
        {
          type: "button",
          data: { name: `${what} ${number}` },
          ariaPressed,
          ariaLabel: t(TEXTS[what], { name }),
          title: t(TEXTS[what], { name }),
          onclick: () => does(number),
        },
        sign,
      );
    return [key("compare", "\u2260", compare, String(number === compared)), key("first", "\u2260\u2081", first, null)];
  }

  return {
    table,
    lanes,
    /** @param {TimeBranch[]} branches @param {number} present */
    list(branches, present) {
      fill(
        rows,
        ...branches.map((each) =>
          h(
            "tr",
            { data: { branch: String(each.number) }, className: each.number === present ? "is-present" : "" },
            h("td", {}, each.number === present ? h("strong", {}, each.name, " \u25c0") : each.name),
            h("td.number", {}, seconds(each.fork ?? each.first)),
            h("td.number", {}, each.last === null ? "\u2026" : seconds(each.last)),
            h(
              "td.row.wrap",
              {},
              keyOf(TEXTS.name, () => void rename(each)),
              ...(each.number === present
                ? []
                : [
                    keyOf(TEXTS.switch, () => change(each.number)),
                    keyOf(TEXTS.forget, () => void give("timeline.forget", { number: each.number })),
                  ]),
            ),
          ),
        ),
      );
    },
    /**
     * @param {TimeBranch[]} branches
     * @param {number} present
     * @param {number | null} compared
     * @param {number} last of the present branch
     * @param {Part} part
     */
    draw(branches, present, compared, last, part) {
      const inPart = (/** @type {number} */ tick) => placeOf(Math.max(part[0], Math.min(part[1], tick)), part);
      fill(
        lanes,
        ...(branches.length < 2 ? [] : branches).map((each) => {
          const [from, to] = [inPart(each.fork ?? each.first), inPart(each.last ?? last)];
          const isPresent = each.number === present;
          return h(
            "div.time-branch",
            {
              className: isPresent ? "time-branch is-present" : "time-branch",
              data: { lane: `branch ${each.number}` },
            },
            h(
              "span.time-branch-keys",
              {},
              h(
                "button.time-name",
                {
                  type: "button",
                  data: { name: `to ${each.number}` },
                  ariaPressed: String(isPresent),
                  disabled: isPresent,
                  title: t(TEXTS.show, { name: each.name }),
                  onclick: () => change(each.number),
                },
                h("span", {}, each.name),
              ),
              ...(isPresent ? [] : keysOf(each, compared)),
            ),
            h("span.time-span", { style: `left: ${from}%; width: ${Math.max(0, to - from)}%` }),
          );
        }),
      );
    },
  };
}
