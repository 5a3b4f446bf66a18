// Looks for the next or previous event of the timeline: a change of a flag, a line of a program, a bookmark, an alarm.
import { get } from "../core/api.js";
import { refuse } from "../core/app.js";
import { h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { neighbour } from "./time_view.js";

const TEXTS = {
  what: { en: "What is looked for", de: "Wonach gesucht wird" },
  flag: { en: "a change of flag", de: "einen Wechsel von Bit" },
  line: { en: "a line of program", de: "eine Zeile von Programm" },
  mark: { en: "a bookmark", de: "ein Lesezeichen" },
  alarm: { en: "an error or alarm", de: "einen Fehler oder Alarm" },
  flagName: { en: "BIT516 or its name", de: "BIT516 oder sein Name" },
  program: { en: "Program", de: "Programm" },
  lineNumber: { en: "Line", de: "Zeile" },
  previous: { en: "\u25c0 PREVIOUS", de: "\u25c0 VORIGE" },
  next: { en: "NEXT \u25b6", de: "N\u00c4CHSTE \u25b6" },
  none: { en: "there is none {where} this moment", de: "{where} diesem Zeitpunkt gibt es keines" },
  before: { en: "before", de: "vor" },
  after: { en: "after", de: "nach" },
};

/**
 * @param {{ now: () => { branch: number, tick: number, bookmarks: { tick: number, kind: string }[] },
 *   seek: (tick: number) => Promise<void>, kept: Record<string, any>, keep: (kept: Record<string, any>) => void }} asked
 */
export function createSearch({ now, seek, kept, keep }) {
  const kinds = /** @type {const} */ (["flag", "line", "mark", "alarm"]);
  const what = h(
    "select.field",
    { ariaLabel: t(TEXTS.what), onchange: show },
    ...kinds.map((each) => h("option", { value: each }, t(TEXTS[each]))),
  );
  what.value = kept.what ?? "flag";
  const flag = h("input.field", {
    ariaLabel: t(TEXTS.flagName),
    placeholder: t(TEXTS.flagName),
    value: kept.flag ?? "",
  });
  const number = (/** @type {import("../core/texts.js").Said} */ label, /** @type {number} */ max) =>
    h("input.field.time-number", {
      type: "number",
      min: "0",
      max: String(max),
      ariaLabel: t(label),
      placeholder: t(label),
    });
  const [program, line] = [number(TEXTS.program, 15), number(TEXTS.lineNumber, 999999)];
  [program.value, line.value] = [kept.program ?? "0", kept.line ?? ""];
  const element = h(
    "form.row.wrap.time-search",
    {
      role: "search",
      onsubmit: (/** @type {Event} */ event) => {
        event.preventDefault();
        void find(false);
      },
    },
    what,
    flag,
    program,
    line,
    keyOf(TEXTS.previous, () => void find(true)),
    h("button.key", { type: "submit" }, t(TEXTS.next)),
  );
  function show() {
    flag.hidden = what.value !== "flag";
    program.hidden = line.hidden = what.value !== "line";
  }
  show();

  /** @param {boolean} back */
  async function find(back) {
    keep({ what: what.value, flag: flag.value, program: program.value, line: line.value });
    const { branch, tick, bookmarks } = now();
    const place = { branch, tick, back: String(back) };
    try {
      if (what.value === "flag")
        await seek((await get("timeline/find", { ...place, flag: flag.value.trim() || "?" })).tick);
      else if (what.value === "line")
        await seek(
          (await get("timeline/find", { ...place, program: Number(program.value), line: Number(line.value) })).tick,
        );
      else {
        const ticks = bookmarks
          .filter(({ kind }) => what.value === "mark" || kind === "error" || kind === "alarm")
          .map((each) => each.tick);
        const found = neighbour(ticks, tick, back);
        if (found === undefined) refuse(t(TEXTS.none, { where: t(back ? TEXTS.before : TEXTS.after) }));
        else await seek(found);
      }
    } catch (reason) {
      refuse(reason);
    }
  }

  return { element, find };
}
