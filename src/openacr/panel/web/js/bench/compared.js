// Two branches of the timeline over the same time: curves of parameters, and what differs at a moment.
import { get, latest } from "../core/api.js";
import { model } from "../core/app.js";
import { fill, h, setText } from "../core/dom.js";
import { plain } from "../core/format.js";
import { t } from "../core/texts.js";
import { uPlot } from "../../vendor/uplot.js";
import { axisSize, endsOf, valueText } from "./charts.js";

const COLORS = ["#1f77b4", "#e07b00", "#2ca02c", "#d62758", "#9467bd", "#8c564b", "#e377c2", "#17becf"];
const SAMPLES = 500;
const HEIGHT = 96; // pixels of a chart
const AXIS = 34; // and of the time below the last one

/**
 * @param {{ kept: Record<string, any>, keep: (values: Record<string, any>) => void,
 *   seconds: (tick: number) => string }} place
 */
export function compare({ kept, keep, seconds }) {
  const names = h("input.field.grow", {
    ariaLabel: t("time.parameters"),
    placeholder: t("time.names"),
    value: kept.parameters ?? "",
    autocomplete: "off",
    spellcheck: false,
  });
  const other = h("select.field.time-other", { ariaLabel: t("time.other") });
  const around = h(
    "select.field",
    { ariaLabel: t("time.around") },
    ...[0.1, 1, 10].map((each) => h("option", { value: String(each) }, `\u00b1 ${each} s`)),
  );
  around.value = "1";
  const chart = h("div.time-chart", {});
  const found = h("div.time-found", {});
  const element = h(
    "div",
    {},
    h(
      "form.row.wrap",
      {
        onsubmit: (/** @type {Event} */ event) => {
          event.preventDefault();
          keep({ parameters: names.value });
          void draw().catch(refuseHere);
        },
      },
      names,
      other,
      around,
      h("button.key", { type: "submit" }, t("time.compare")),
    ),
    chart,
    found,
  );
  /** One for each parameter. @type {any[]} */
  let plots = [];
  const newest = latest();

  /** @param {unknown} reason */
  function refuseHere(reason) {
    fill(found, h("p.notice", { role: "alert" }, reason instanceof Error ? reason.message : String(reason)));
  }

  function clear() {
    for (const each of plots.splice(0)) each.destroy();
    fill(chart);
  }

  async function draw() {
    const { branch, branches, period_s: period } = model.timeline.value;
    const { tick, last } = model.moment.value;
    const chosen = branches.find((each) => each.number === Number(other.value));
    const own = branches.find((each) => each.number === branch);
    clear();
    if (!chosen || !own) return refuseHere(t("time.noother"));
    const reach = Math.round(Number(around.value) / period);
    const [first, end] = [Math.max(own.first, chosen.first), Math.min(last, chosen.last ?? last)];
    const at = Math.min(end, Math.max(first, tick));
    const [from, to] = [Math.max(first, at - reach), Math.min(end, at + reach)];
    if (to <= from) return refuseHere(t("time.apart"));
    setText(found, t("time.comparing"));
    const query = { parameters: names.value, first: from, last: to, count: SAMPLES };
    const sampled = async () =>
      query.parameters.trim()
        ? [
            await get("timeline/samples", { branch, ...query }),
            await get("timeline/samples", { branch: chosen.number, ...query }),
          ]
        : [];
    const both = await newest(sampled());
    if (!both) return;
    show(both, period, [own.name, chosen.name]);
    const answer = await newest(get("timeline/differences", { branch, other: chosen.number, tick: at }));
    if (!answer) return;
    const { count, differences } = answer;
    fill(
      found,
      h("p", { data: { count: String(count) } }, t("time.differences", { count: String(count), seconds: seconds(at) })),
      h(
        "table.grid",
        {},
        h(
          "tbody",
          {},
          ...differences.map((/** @type {any} */ each) =>
            h(
              "tr",
              {},
              h("td.number", {}, `P${each.number}`),
              h("td", {}, each.name),
              ...each.values.map((/** @type {number | null} */ value) =>
                h("td.number", {}, value === null ? "\u2013" : plain(value, 6)),
              ),
            ),
          ),
        ),
      ),
    );
  }

  /**
   * A chart for each parameter, with its own scale; the time is below the last one.
   * @param {{ first: number, every: number, names: string[], channels: number[][] }[]} both
   * @param {number} period
   * @param {string[]} branches
   */
  function show(both, period, branches) {
    clear();
    if (!both.length) return;
    const { first, every, names: shown, channels } = both[0];
    const style = getComputedStyle(chart);
    const axis = {
      stroke: style.color,
      grid: { stroke: style.borderColor, width: 1 },
      ticks: { stroke: style.borderColor },
    };
    const times = channels[0].map((_each, n) => (first + n * every) * period);
    const size = Math.max(
      ...shown.map((_each, place) =>
        axisSize(
          endsOf(both.map((each) => each.channels[place])).map((each) => valueText(Number(each.toPrecision(3)))),
        ),
      ),
    );
    plots = shown.map((name, place) => {
      const curves = both.map((each) => each.channels[place]);
      const isLast = place === shown.length - 1;
      const color = COLORS[place];
      const legend = h(
        "p.time-legend",
        {},
        h("strong", { style: `color: ${color}` }, name),
        ...branches.map((each, n) =>
          h(
            "span",
            {},
            h(n ? "span.time-key.is-other" : "span.time-key", { style: `border-color: ${color}` }),
            `${each} `,
            h("span", { data: { value: String(n) } }),
          ),
        ),
      );
      const host = h("div", { data: { parameter: name } }, legend);
      chart.append(host);
      const values = (/** @type {any} */ self) =>
        legend
          .querySelectorAll("[data-value]")
          .forEach((each, n) =>
            setText(
              each,
              self.cursor.idx === null || self.cursor.idx === undefined ? "" : valueText(curves[n][self.cursor.idx]),
            ),
          );
      return new uPlot(
        {
          width: Math.max(200, chart.clientWidth),
          height: HEIGHT + (isLast ? AXIS : 0),
          legend: { show: false },
          cursor: { sync: { key: "time-compare" } },
          hooks: { setCursor: [values] },
          scales: { x: { time: false }, y: { range: () => endsOf(curves) } },
          axes: [
            isLast ? { ...axis, label: "s", labelSize: 16, size: AXIS } : { ...axis, size: 4, values: () => [] },
            {
              ...axis,
              size: (_self, labels) => Math.max(size, axisSize(labels)),
              values: (_self, splits) => splits.map((each) => valueText(each)),
            },
          ],
          series: [{}, ...curves.map((_each, n) => ({ stroke: color, width: 1.6, dash: n ? [6, 4] : [] }))],
        },
        /** @type {any} */ ([times, ...curves]),
        host,
      );
    });
    chart.dataset.parameters = String(shown.length);
  }

  /**
   * Curves of the present branch over a part of it.
   * @param {import("./time_view.js").Part} part
   * @param {string[]} offered where nothing is named
   */
  async function over([first, last], offered) {
    const { branch, branches, period_s: period } = model.timeline.value;
    if (!names.value.trim()) names.value = offered.slice(0, COLORS.length).join(", ");
    keep({ parameters: names.value });
    const own = branches.find((each) => each.number === branch);
    setText(found, t("time.curves"));
    try {
      const sampled = await newest(
        get("timeline/samples", { branch, parameters: names.value, first, last, count: SAMPLES }),
      );
      if (!sampled || !own) return;
      fill(found);
      show([sampled], period, [own.name]);
      chart.scrollIntoView({ block: "nearest" });
    } catch (reason) {
      clear();
      refuseHere(reason);
    }
  }

  return {
    element,
    /** Compare more parameters or flags. @param {string[]} ids */
    add(ids) {
      const before = names.value
        .split(/[;,]/)
        .map((each) => each.trim())
        .filter(Boolean);
      names.value = [...new Set([...before, ...ids])].join(", ");
      keep({ parameters: names.value });
      names.scrollIntoView({ block: "nearest" });
      if (other.value) void draw().catch(refuseHere);
    },
    over,
    /** @param {import("../core/model.js").TimeBranch[]} branches */
    offer(branches) {
      const before = other.value;
      fill(other, ...branches.map((each) => h("option", { value: String(each.number) }, each.name)));
      if (branches.some((each) => String(each.number) === before)) other.value = before;
    },
    end: clear,
  };
}
