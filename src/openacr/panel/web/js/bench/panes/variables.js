// Variables: those of a program, the parameters and flags in its text, its flow stack and what it waits for.
import { get, latest } from "../../core/api.js";
import { give, model, refuse, report } from "../../core/app.js";
import { fill, h, setText } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { chosenProgram, needPrograms } from "../../core/programs.js";
import { Endings } from "../../core/signal.js";
import { t } from "../../core/texts.js";
import { LiveItems, fullName } from "../../frame/card_value.js";
import { askText } from "../../frame/dialog.js";
import { stateText } from "../../screens/programs.js";

const TEXTS = {
  program: { en: "Program", de: "Programm" },
  levels: { en: "Flow stack", de: "Ablaufstapel" },
  nolevels: { en: "No level is open", de: "Keine Ebene ist offen" },
  own: { en: "Variables of the program", de: "Variablen des Programms" },
  none: { en: "None is dimensioned", de: "Keine ist dimensioniert" },
  used: { en: "Parameters and flags in its text", de: "Parameter und Merker in seinem Text" },
  value: { en: "Value or expression", de: "Wert oder Ausdruck" },
};

const EVERY_MS = 1000;
const COUNT = 16;

/**
 * @typedef {import("../../frame/card_value.js").Item} Item
 * @typedef {{ name: string, text: string, elements: Variable[] }} Variable
 */

/**
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head, kept, keep }) {
  const endings = new Endings();
  const live = new LiveItems(update);
  let program = Number(kept.program ?? /^PROG(\d+)$/.exec(chosenProgram.value)?.[1] ?? 0);
  const [newestOwn, newestUsed] = [latest(endings), latest(endings)];
  let isEnded = false;
  let drawn = "";
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  /** @type {{ item: Item, value: HTMLElement }[]} */
  let used = [];
  const choice = h(
    "select.field",
    { ariaLabel: t(TEXTS.program), onchange: () => void choose(Number(choice.value)) },
    ...Array.from({ length: COUNT }, (_each, n) => h("option", { value: String(n) }, `PROG${n}`)),
  );
  const state = h("strong.grow", { role: "status" });
  head.append(
    choice,
    state,
    keyOf("programs.read", () => void choose(program)),
  );
  const levels = h("div.program-levels", { role: "region", ariaLabel: t(TEXTS.levels) });
  const own = h("tbody", { data: { part: "own" } });
  const shared = h("tbody", { data: { part: "used" } });
  host.append(levels, h("div.grow.scroll", { tabIndex: 0 }, h("table.grid.watch-table", {}, own, shared)));

  /** @param {number} number */
  async function choose(number) {
    program = number;
    choice.value = String(number);
    keep({ program });
    drawn = "";
    await Promise.all([readUsed(), readOwn()]);
  }

  async function readOwn() {
    clearTimeout(timer);
    if (host.offsetParent && !document.hidden) {
      const found = await newestOwn(get("card/variables", { program })).catch((error) => {
        if (!drawn) refuse(error);
        return null;
      });
      if (found === undefined) return; // the one that was asked for since goes on
      if (found) draw(found);
    }
    clearTimeout(timer);
    if (!isEnded) timer = setTimeout(() => void readOwn(), EVERY_MS);
  }

  /** @param {{ variables: Variable[], state: string, levels: { word: string, line: number }[], why: string }} found */
  function draw(found) {
    const text = JSON.stringify(found);
    if (text === drawn) return;
    drawn = text;
    fill(
      levels,
      ...(found.levels.length
        ? found.levels.map(({ word, line }) => h("span.level", {}, `${word} ${line}`))
        : [h("span.hint", {}, found.why || t(TEXTS.nolevels))]),
    );
    fill(
      own,
      headOf(TEXTS.own),
      ...(found.variables.length
        ? found.variables.flatMap((each) =>
            each.elements.length
              ? [rowOf(each, true), ...each.elements.map((element) => rowOf(element))]
              : [rowOf(each)],
          )
        : [h("tr", {}, h("td.quiet", { colSpan: 2 }, t(TEXTS.none)))]),
    );
  }

  /**
   * @param {Variable} variable
   * @param {boolean} [isArray]
   */
  function rowOf({ name, text }, isArray = false) {
    return h(
      "tr",
      { data: { variable: name } },
      h("td", {}, name),
      h(
        "td.number",
        {},
        isArray
          ? text
          : h(
              "button.key",
              { type: "button", ariaLabel: t("watch.change", { name }), onclick: () => change(name, text) },
              h("strong.live", {}, text),
            ),
      ),
    );
  }

  /** @param {import("../../core/texts.js").Said} title */
  function headOf(title) {
    return h("tr", {}, h("th", { colSpan: 2, scope: "rowgroup" }, t(title)));
  }

  /**
   * @param {string} name
   * @param {string} text
   */
  async function change(name, text) {
    const value = await askText(
      t("watch.change", { name }),
      t(TEXTS.value),
      name.startsWith("$") ? `"${text.slice(1, -1)}"` : text,
    );
    if (value === null) return;
    const answer = await give("card.assign", { program, name, value });
    if (answer) report(t("values.is", { name, value: answer.value }));
    await readOwn();
  }

  async function readUsed() {
    const found = await newestUsed(get("card/used", { program })).catch(() => null);
    if (found === undefined) return;
    used = (found?.items ?? []).map((/** @type {Item} */ item) => ({ item, value: h("strong.live", {}) }));
    fill(
      shared,
      headOf(TEXTS.used),
      ...used.map(({ item, value }) =>
        h(
          "tr",
          { data: { item: item.id } },
          h("td", { title: item.doc }, `${item.id} ${fullName(item)}`),
          h("td.number", {}, live.keyOf(item, value)),
        ),
      ),
    );
    live.need(used.map(({ item }) => item));
  }

  function update() {
    for (const { item, value } of used) setText(value, live.text(item));
  }

  endings.add(
    () => {
      isEnded = true;
      clearTimeout(timer);
      live.end();
    },
    needPrograms(),
    model.programs.watch(({ programs }) => {
      const now = programs.find((each) => each.name === `PROG${program}`);
      setText(
        state,
        now
          ? [stateText(now), now.line ? t("programs.line", { line: now.line }) : ""].filter(Boolean).join(" \u00b7 ")
          : "",
      );
    }),
  );
  await choose(program);
  return () => endings.end();
}
