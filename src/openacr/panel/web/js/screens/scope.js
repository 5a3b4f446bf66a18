// SCOPE: four channels sampled by the card, with a trigger.
import { give, link, model } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { plain } from "../core/format.js";
import { Endings } from "../core/signal.js";
import { t } from "../core/texts.js";
import { uPlot } from "../../vendor/uplot.js";

const CHANNELS = 4;
const COLORS = ["#1f77b4", "#e07b00", "#2ca02c", "#d62758"];

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "scope.title",
  area: "full",
  show({ body, head, endings }) {
    const sources = Array.from({ length: CHANNELS }, (_each, n) => h("input.field.grow", { ariaLabel: t("scope.channel", { n: n + 1 }), placeholder: t("scope.source"), value: ["P12290", "P12291", "P12295", ""][n], autocomplete: "off", spellcheck: false }));
    const period = numberField(t("scope.period"), "1");
    const samples = numberField(t("scope.samples"), "2000");
    const level = numberField(t("scope.level"), "0");
    const mode = selectField(t("scope.mode"), ["free", "auto", "normal", "single"]);
    const slope = selectField(t("scope.slope"), ["rising", "falling"]);
    const state = h("span.hint.grow", { role: "status" });
    const chart = h("div.scope-chart.grow", {});
    /** @type {number[][]} */
    let data = [[]];
    const run = new Endings();
    endings.add(() => run.end(), () => void (link.isOpen.value && link.command("scope.stop").catch(() => {})));
    head.append(h("button.key.main", { type: "button", onclick: () => arm() }, t("scope.start")), h("button.key", { type: "button", onclick: () => stop() }, t("scope.stop")));
    body.append(h("div.scope-settings", {}, ...sources.map((each, n) => {
      const mark = h("i.scope-mark", {});
      mark.style.background = COLORS[n];
      return h("label.row", {}, mark, h("strong", {}, String(n + 1)), each);
    }), period.label, samples.label, mode.label, slope.label, level.label), chart, state);
    const plot = new uPlot(options(chart), /** @type {any} */ (data), chart);
    const sizes = new ResizeObserver(() => plot.setSize({ width: chart.clientWidth, height: Math.max(120, chart.clientHeight - 34) }));
    sizes.observe(chart);
    endings.add(() => sizes.disconnect(), () => plot.destroy(), model.scope.watch((piece) => {
      if (!piece || !run.list.length) return;
      if (piece.first === 0) data = [[], ...piece.channels.map(() => [])];
      for (let n = 0; n < piece.channels[0].length; n++) data[0].push((piece.first + n) * piece.period);
      piece.channels.forEach((channel, n) => data[n + 1].push(...channel));
      plot.setData(/** @type {any} */ (data));
      setText(state, t("scope.read", { count: data[0].length }));
    }));

    async function arm() {
      run.end();
      const channels = sources.map((each) => each.value.trim()).filter(Boolean).map((text) => (/^P?\d+$/i.test(text) ? Number(text.replace(/^P/i, "")) : text));
      const trigger = mode.field.value === "free" ? null : { channel: 0, level: Number(level.field.value), slope: slope.field.value === "rising" ? 1 : -1, mode: mode.field.value, before: 0.1 };
      data = [[], ...channels.map(() => [])];
      while (plot.series.length > 1) plot.delSeries(1);
      channels.forEach((each, n) => plot.addSeries({ label: typeof each === "number" ? `P${each}` : each, stroke: COLORS[n], width: 1.6, value: (_plot, value) => (value === null ? "\u2013" : plain(value, 4)) }));
      run.add(link.subscribe({ topic: "scope", hz: 10 }));
      const done = await give("scope.arm", { channels, period_ms: Number(period.field.value), samples: Number(samples.field.value), trigger });
      setText(state, done ? t("scope.armed") : "");
    }

    async function stop() {
      await give("scope.stop");
      setText(state, t("scope.stopped", { count: data[0].length }));
    }
  },
};

/** @param {HTMLElement} chart */
function options(chart) {
  const style = getComputedStyle(chart);
  const axis = { stroke: style.color, grid: { stroke: style.borderColor, width: 1 }, ticks: { stroke: style.borderColor } };
  return { width: Math.max(200, chart.clientWidth), height: 240, scales: { x: { time: false } }, axes: [{ ...axis, label: "s" }, { ...axis, size: 84 }], series: [{ label: "s" }] };
}

/**
 * @param {string} label
 * @param {string} value
 */
function numberField(label, value) {
  const field = h("input.field.number", { value, inputMode: "decimal", autocomplete: "off" });
  return { field, label: h("label.row", {}, h("span.grow", {}, label), field) };
}

/**
 * @param {string} label
 * @param {string[]} values
 */
function selectField(label, values) {
  const field = h("select.field", {}, ...values.map((value) => h("option", { value }, t(/** @type {any} */ (`scope.${value}`)))));
  return { field, label: h("label.row", {}, h("span.grow", {}, label), field) };
}
