// The sets of gains that an axis has had, with what each has changed: UNDO, REDO, or any of them with one press.
import { give, link, report } from "../../core/app.js";
import { fill, h } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { Endings } from "../../core/signal.js";
import { t } from "../../core/texts.js";
import { neighbours } from "./sets_list.js";

const TEXTS = {
  back: { en: "BACK TO THIS", de: "HIERHER ZURÜCK" },
  backTo: { en: "Back to the gains of {time}, set {number}", de: "Zurück zu den Werten von {time}, Satz {number}" },
  wentBack: { en: "The gains are those of {time}", de: "Es gelten die Werte von {time}" },
  start: { en: "as they were found", de: "wie vorgefunden" },
  elsewhere: { en: "changed elsewhere", de: "anderswo geändert" },
  now: { en: "in force", de: "gilt jetzt" },
};
const EVERY_MS = 2000;

/**
 * @typedef {import("./sets_list.js").Sets} Sets
 * @typedef {{ refresh: () => Promise<void>, current: () => number, end: () => void }} GainSets
 */

/**
 * Show the sets of an axis, and keep them up to date while they are seen.
 * @param {HTMLElement} host
 * @param {import("../../core/card_axes.js").CardAxis} axis
 * @param {() => boolean} isStored whether gains are kept in the parameters of the machine as well
 * @param {(gains: Record<string, number>) => void} changed the gains that are in force
 * @returns {GainSets}
 */
export function gainSets(host, axis, isStored, changed) {
  const endings = new Endings();
  /** @type {Sets} */
  let found = { current: 0, sets: [], gains: {} };
  let drawn = "";
  let isEnded = false;
  const list = h("ol.tune-changes.scroll", { ariaLabel: t("tune.changes") });
  const [undo, redo, start] = /** @type {const} */ (["undo", "redo", "start"]).map((word) =>
    keyOf(`tune.${word}`, () => void back(neighbours(found)[word]), "", { disabled: true }),
  );
  fill(host, h("div.row.wrap", {}, undo, redo, start), list);

  async function refresh() {
    const answer = await link.command("tune.sets", { axis: axis.name }).catch(() => null); // asked again
    if (answer && !isEnded) draw(answer);
  }

  /** @param {number} number */
  async function back(number) {
    const answer = await give("tune.back", { axis: axis.name, number, store: isStored() });
    if (!answer || isEnded) return;
    draw(answer);
    const set = found.sets.find((each) => each.number === number);
    if (set) report(t(TEXTS.wentBack, { time: timeOf(set) }));
  }

  /** @param {Sets} answer */
  function draw(answer) {
    const text = JSON.stringify([answer.current, answer.gains, answer.sets.map((set) => [set.number, set.changed])]);
    found = answer;
    if (text === drawn) return;
    drawn = text;
    const to = neighbours(found);
    undo.disabled = !to.undo;
    redo.disabled = !to.redo;
    start.disabled = !to.start;
    fill(list, ...[...found.sets].reverse().map(rowOf));
    changed(found.gains);
  }

  /** @param {Sets["sets"][number]} set */
  function rowOf(set) {
    const isNow = set.number === found.current;
    const time = timeOf(set);
    const what = set.changed.map(([name, before, after]) => `${name}: ${before} \u2192 ${after}`).join(", ");
    return h(
      "li",
      { data: { set: String(set.number), by: set.by }, attr: { "aria-current": isNow ? "true" : null } },
      h("time.quiet", {}, time),
      ` ${set.by === "start" ? t(TEXTS.start) : what} `,
      set.by === "elsewhere" ? h("strong.tune-elsewhere", {}, t(TEXTS.elsewhere)) : "",
      isNow
        ? h("em.quiet", {}, ` ${t(TEXTS.now)}`)
        : keyOf(TEXTS.back, () => void back(set.number), "", {
            ariaLabel: t(TEXTS.backTo, { time, number: set.number }),
          }),
    );
  }

  const timer = setInterval(() => {
    if (host.offsetParent && !document.hidden) void refresh();
  }, EVERY_MS);
  endings.add(
    () => clearInterval(timer),
    () => {
      isEnded = true;
    },
  );
  return { refresh, current: () => found.current, end: () => endings.end() };
}

/** @param {{ age_s: number }} set */
function timeOf({ age_s: age }) {
  return new Date(Date.now() - 1000 * age).toLocaleTimeString();
}
