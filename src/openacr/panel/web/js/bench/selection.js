// A selected span of the timeline: how long it is, and what happened in it, lane by lane.
import { get, latest } from "../core/api.js";
import { fill, h, setText } from "../core/dom.js";
import { plain } from "../core/format.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { labelOf } from "./lanes.js";
import { isTraffic, lanesOf } from "./lane_list.js";

const TEXTS = {
  length: {
    en: "Selected: {seconds} s, from {from} to {to} s",
    de: "Ausgew\u00e4hlt: {seconds} s, von {from} bis {to} s",
  },
  zoom: { en: "ZOOM TO SELECTION", de: "AUSWAHL VERGR\u00d6SSERN" },
  curves: { en: "CURVES", de: "KURVEN" },
  clear: { en: "CLEAR SELECTION", de: "AUSWAHL AUFHEBEN" },
  lane: { en: "Lane", de: "Spur" },
  on: { en: "on, s", de: "ein, s" },
  share: { en: "%", de: "%" },
  changes: { en: "changes", de: "Wechsel" },
  more: { en: "in it", de: "darin" },
  distance: { en: "{distance} units of distance", de: "{distance} Einheiten Weg" },
  lines: { en: "{lines} {lines|line|lines}", de: "{lines} {lines|Zeile|Zeilen}" },
  from: { en: "from {name}", de: "von {name}" },
  sent: { en: "to {name}", de: "an {name}" },
  host: {
    en: "{packets} {packets|packet|packets}, {lines} {lines|line|lines}",
    de: "{packets} {packets|Paket|Pakete}, {lines} {lines|Zeile|Zeilen}",
  },
  short: {
    en: "Distances and executed lines are added up for up to {most} s",
    de: "Wege und ausgef\u00fchrte Zeilen werden bis zu {most} s zusammengez\u00e4hlt",
  },
};

/**
 * @typedef {import("./time_view.js").Part} Part
 * @param {{ seconds: (tick: number) => string, period: () => number, branch: () => number, most: number,
 *   zoom: (part: Part) => void, curves: (part: Part, names: string[]) => void, clear: () => void }} asked
 */
export function createSelection({ seconds, period, branch, most, zoom, curves, clear }) {
  const [length, rows, hint] = [h("strong.time-length", {}), h("tbody", {}), h("p.hint", {})];
  const heads = [TEXTS.lane, TEXTS.on, TEXTS.share, TEXTS.changes, TEXTS.more];
  /** @type {Part | null} */
  let part = null;
  /** Axes that moved in it. @type {number[]} */
  let moved = [];
  const element = h(
    "div.time-sums",
    { hidden: true },
    h(
      "div.row.wrap",
      {},
      length,
      keyOf(TEXTS.zoom, () => part && zoom(part)),
      keyOf(
        TEXTS.curves,
        () =>
          part &&
          curves(
            part,
            moved.map((axis) => `axis${axis}.primary setpoint`),
          ),
      ),
      keyOf(TEXTS.clear, clear),
    ),
    h("table.grid", {}, h("thead", {}, h("tr", {}, ...heads.map((each) => h("th", {}, t(each))))), rows),
    hint,
  );
  const newest = latest();

  /** @param {Part} chosen */
  async function add([first, last]) {
    const where = { branch: branch(), first, last };
    const isShort = (last - first) * period() <= most;
    const found = await newest(
      Promise.all([get("timeline/lanes", where), isShort ? get("timeline/details", { ...where, columns: 2 }) : null]),
    );
    if (!found) return;
    const [answer, details] = found;
    const lanes = lanesOf(answer).filter((lane) => lane.on || lane.changes);
    moved = lanes.filter((lane) => lane.kind === "axis").map((lane) => Number(lane.id.split(" ")[1]));
    fill(
      rows,
      ...lanes.map((lane) =>
        h(
          "tr",
          { data: { sum: lane.id } },
          h(
            "td",
            {},
            isTraffic(lane) ? t(lane.kind === "host" ? TEXTS.from : TEXTS.sent, { name: lane.name }) : labelOf(lane),
          ),
          h("td.number", {}, isTraffic(lane) ? "" : seconds(lane.on)),
          h("td.number", {}, isTraffic(lane) ? "" : plain((100 * lane.on) / (last - first), 1)),
          h("td.number", {}, isTraffic(lane) ? "" : String(lane.changes)),
          h("td", {}, inIt(lane, details)),
        ),
      ),
    );
    setText(hint, isShort ? "" : t(TEXTS.short, { most: String(most) }));
  }

  /** @param {import("./lane_list.js").Lane} lane @param {any} details */
  function inIt(lane, details) {
    const number = Number(lane.id.split(" ")[1]);
    const of = (/** @type {string} */ group) =>
      details?.[group].find((/** @type {any} */ each) => each.number === number);
    if (isTraffic(lane)) return t(TEXTS.host, { packets: String(lane.packets), lines: String(lane.lines) });
    if (lane.kind === "axis" && of("axes")) return t(TEXTS.distance, { distance: plain(of("axes").distance, 4) });
    if (lane.kind === "program" && of("programs")) return t(TEXTS.lines, { lines: String(of("programs").lines) });
    return "";
  }

  return {
    element,
    /** @param {Part | null} chosen */
    async show(chosen) {
      part = chosen;
      element.hidden = !chosen;
      if (!chosen) return;
      const [from, to] = chosen;
      setText(length, t(TEXTS.length, { seconds: seconds(to - from), from: seconds(from), to: seconds(to) }));
      await add(chosen);
    },
  };
}
