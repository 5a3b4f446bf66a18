// Feed, spindle, tool, times and parts of the run.
import { model } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { duration, plain } from "../core/format.js";
import { lengthFactor, shownUnit } from "../core/units.js";
import { t } from "../core/texts.js";

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export function feedsBlock(panel, endings) {
  const [unit, factor] = [shownUnit(), lengthFactor()];
  const perMinute = `${unit}/min`;
  const decimals = unit === "mm" ? 0 : 1;
  /** @type {[string, string, (status: import("../core/frames.js").Status) => string][]} */
  const rows = [
    [t("feeds.actual"), perMinute, (status) => plain(status.feedActual * factor, decimals)],
    [t("feeds.set"), perMinute, (status) => plain(status.feedSet * factor, decimals)],
    [t("feeds.spindle"), t("feeds.rpm"), (status) => (model.is("spindle") ? plain(status.spindle) : t("feeds.off"))],
    [t("feeds.tool"), "", (status) => `T${status.tool}`],
    [
      t("feeds.coolant"),
      "",
      () =>
        [model.is("flood") && t("feeds.flood"), model.is("mist") && t("feeds.mist")].filter(Boolean).join(" ") ||
        t("feeds.off"),
    ],
    [t("feeds.line"), "", (status) => (status.line ? String(status.line) : "\u2013")],
    [t("feeds.time"), "", (status) => duration(status.runTime)],
    [t("feeds.left"), "", (status) => duration(status.timeLeft)],
    [t("feeds.parts"), "", (status) => plain(status.parts)],
  ];
  const cells = rows.map(([label, quantity, text]) => ({
    text,
    label,
    quantity,
    value: h("span.value.live", {}, "\u2013"),
  }));
  panel.append(
    h(
      "section.block",
      { ariaLabel: t("block.feeds") },
      h(
        "dl.facts",
        {},
        ...cells.map(({ label, quantity, value }) =>
          h("div", {}, h("dt", {}, label, quantity ? ` ${quantity}` : ""), h("dd", {}, value)),
        ),
      ),
    ),
  );
  endings.add(
    model.status.watch((status) => status && cells.forEach(({ text, value }) => setText(value, text(status)))),
  );
}
