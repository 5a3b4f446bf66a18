// Where another branch of the timeline first does something else: outputs, positions of axes, lines of programs.
import { get, latest } from "../core/api.js";
import { model, refuse } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { plain } from "../core/format.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";

const TEXTS = {
  seeking: {
    en: "Both branches are lived through from their first different input on \u2026",
    de: "Beide Zweige werden ab ihrer ersten verschiedenen Eingabe noch einmal durchlebt \u2026",
  },
  title: { en: "First differences from {name}", de: "Erste Unterschiede zu {name}" },
  time: { en: "s", de: "s" },
  what: { en: "What", de: "Was" },
  output: { en: "output {name}", de: "Ausgang {name}" },
  setpoint: { en: "setpoint of {name}", de: "Sollwert von {name}" },
  actual: { en: "actual position of {name}", de: "Istposition von {name}" },
  line: { en: "line of {name}", de: "Zeile von {name}" },
  which: {
    en: "F goes to the first difference from another branch: choose one by its \u2260",
    de: "F geht zum ersten Unterschied zu einem anderen Zweig: einen mit seinem \u2260 w\u00e4hlen",
  },
  close: { en: "CLOSE", de: "SCHLIESSEN" },
};

/**
 * @typedef {{ kind: "output" | "setpoint" | "actual" | "line", tick: number, name: string,
 *   values: (number | null)[] }} Difference
 * @param {{ seconds: (tick: number) => string, seek: (tick: number) => Promise<void>,
 *   show: (other: number, tick: number) => void }} asked
 */
export function createFirstDifference({ seconds, seek, show }) {
  const element = h("div.time-first", { hidden: true, role: "status" });
  const newest = latest();
  let found = Number.NaN; // the branch that is compared
  const close = () => {
    element.hidden = true;
    found = Number.NaN;
  };

  /** @param {Difference} each */
  const row = ({ kind, tick, name, values }) =>
    h(
      "tr",
      { data: { difference: kind } },
      h("td.number", {}, h("button.key", { type: "button", onclick: () => void seek(tick) }, seconds(tick))),
      h("td", {}, t(TEXTS[kind], { name })),
      ...values.map((value) =>
        h("td.number", {}, value === null ? "\u2013" : Number.isInteger(value) ? String(value) : plain(value, 6)),
      ),
    );

  /** Find them, list them and go to the first one. @param {number} other */
  async function find(other) {
    const { branch, branches } = model.timeline.value;
    const nameOf = (/** @type {number} */ number) => branches.find((each) => each.number === number)?.name ?? "";
    found = other;
    element.hidden = false;
    fill(element, h("p.hint", {}, t(TEXTS.seeking)));
    try {
      const answer = await newest(get("timeline/first-difference", { branch, other }));
      if (!answer || found !== other) return;
      const heads = [t(TEXTS.time), t(TEXTS.what), nameOf(branch), nameOf(other)];
      fill(
        element,
        h("div.row", {}, h("strong.grow", {}, t(TEXTS.title, { name: nameOf(other) })), keyOf(TEXTS.close, close)),
        h(
          "table.grid",
          {},
          h("thead", {}, h("tr", {}, ...heads.map((each) => h("th", {}, each)))),
          h("tbody", {}, ...answer.differences.map(row)),
        ),
      );
      const { tick } = answer.differences[0];
      show(other, tick);
      await seek(tick);
    } catch (reason) {
      fill(element, h("p.notice", { role: "alert" }, reason instanceof Error ? reason.message : String(reason)));
    }
  }

  return {
    element,
    find,
    /** Find those of the branch that is compared, else of the only other one. @param {number | null} compared */
    byKey(compared) {
      const { branch, branches } = model.timeline.value;
      const others = branches.map((each) => each.number).filter((number) => number !== branch);
      const other = compared ?? (others.length === 1 ? others[0] : null);
      if (other === null) refuse(t(TEXTS.which));
      else void find(other);
    },
    /** Nothing is listed of a branch that is gone, or the present one. @param {number[]} others */
    keep(others) {
      if (!others.includes(found)) close();
    },
  };
}
