// Two branches of the timeline over the same time: curves of parameters, and what differs at a moment.
import { get, latest } from "../core/api.js";
import { model, refuse } from "../core/app.js";
import { fill, h, setText } from "../core/dom.js";
import { plain } from "../core/format.js";
import { t } from "../core/texts.js";
import { uPlot } from "../../vendor/uplot.js";

const COLORS = ["#1f77b4", "#e07b00", "#2ca02c", "#d62758", "#9467bd", "#8c564b", "#e377c2", "#17becf"];
const SAMPLES = 500;

/**
 * @param {{ kept: Record<string, any>, keep: (values: Record<string, any>) => void, seconds: (tick: number) => string }} place
 */
export function compare({ kept, keep, seconds }) {
  const names = h("input.field.grow", { ariaLabel: t("time.parameters"), placeholder: t("watch.name"), value: kept.parameters ?? "", autocomplete: "off", spellcheck: false });
  const other = h("select.field.time-other", { ariaLabel: t("time.other") });
  const around = h("select.field", { ariaLabel: t("time.around") }, ...[0.1, 1, 10].map((each) => h("option", { value: String(each) }, `\u00b1 ${each} s`)));
  around.value = "1";
  const chart = h("div.time-chart", {});
  const found = h("div.time-found", {});
  const element = h("div", {}, h("form.row.wrap", { onsubmit: (/** @type {Event} */ event) => {
    event.preventDefault();
    keep({ parameters: names.value });
    void draw().catch(refuse);
  } }, names, other, around, h("button.key", { type: "submit" }, t("time.compare"))), chart, found);
  /** @type {any} */
  let plot = null;
  const newest = latest();

  async function draw() {
    const { branch, branches, period_s: period } = model.timeline.value;
    const { tick, last } = model.moment.value;
    const chosen = branches.find((each) => each.number === Number(other.value));
    const own = branches.find((each) => each.number === branch);
    if (!chosen || !own) return refuse(t("time.noother"));
    const reach = Math.round(Number(around.value) / period);
    const [first, end] = [Math.max(own.first, chosen.first), Math.min(last, chosen.last ?? last)];
    const at = Math.min(end, Math.max(first, tick));
    const [from, to] = [Math.max(first, at - reach), Math.min(end, at + reach)];
    if (to <= from) return refuse(t("time.apart"));
    setText(found, t("time.comparing"));
    const query = { parameters: names.value, first: from, last: to, count: SAMPLES };
    const sampled = async () => (query.parameters.trim() ? [await get("timeline/samples", { branch, ...query }), await get("timeline/samples", { branch: chosen.number, ...query })] : []);
    const both = await newest(sampled());
    if (!both) return;
    show(both, period);
    const answer = await newest(get("timeline/differences", { branch, other: chosen.number, tick: at }));
    if (!answer) return;
    const { count, differences } = answer;
    fill(found, h("p", { data: { count: String(count) } }, t("time.differences", { count: String(count), seconds: seconds(at) })), h("table.grid", {}, h("tbody", {}, ...differences.map((/** @type {any} */ each) =>
      h("tr", {}, h("td.number", {}, `P${each.number}`), h("td", {}, each.name), ...each.values.map((/** @type {number | null} */ value) => h("td.number", {}, value === null ? "\u2013" : plain(value, 6))))))));
  }

  /**
   * @param {{ first: number, every: number, names: string[], channels: number[][] }[]} both
   * @param {number} period
   */
  function show(both, period) {
    plot?.destroy();
    plot = null;
    if (!both.length) return;
    const { first, every, names: shown, channels } = both[0];
    const style = getComputedStyle(chart);
    const axis = { stroke: style.color, grid: { stroke: style.borderColor, width: 1 }, ticks: { stroke: style.borderColor } };
    const series = both.flatMap((each, n) => each.names.map((name, place) => ({ label: `${name}${n ? "\u2032" : ""}`, stroke: COLORS[place], width: 1.6, dash: n ? [6, 4] : [] })));
    plot = new uPlot({ width: Math.max(240, chart.clientWidth), height: 220, scales: { x: { time: false } }, axes: [{ ...axis, label: "s" }, axis], series: [{ label: "s" }, ...series] },
      /** @type {any} */ ([channels[0].map((_each, n) => (first + n * every) * period), ...both.flatMap((each) => each.channels)]), chart);
    chart.dataset.parameters = String(shown.length);
  }

  return {
    element,
    /** @param {import("../core/model.js").TimeBranch[]} branches */
    offer(branches) {
      const before = other.value;
      fill(other, ...branches.map((each) => h("option", { value: String(each.number) }, each.name)));
      if (branches.some((each) => String(each.number) === before)) other.value = before;
    },
    end: () => plot?.destroy(),
  };
}
