// The ALARMS tab: what is active, and what has been.
import { give, model } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export function alarmsTab(panel, endings) {
  panel.classList.add("scroll");
  const acknowledge = keyOf("alarm.acknowledge", () => give("alarm.acknowledge"), ".main");
  const count = h("strong.grow", {});
  const body = h("tbody", {});
  panel.append(
    h("div.row.pane-tools", {}, count, acknowledge),
    h(
      "table.grid",
      {},
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          ...["alarm.time", "alarm.code", "alarm.text"].map((key) => h("th", {}, t(/** @type {any} */ (key)))),
        ),
      ),
      body,
    ),
  );
  function draw() {
    const past = model.moment.value.alarms; // of a moment of the history
    const { active, history } = past ?? model.alarms.value;
    fill(count, active.length ? t("alarm.count", { count: active.length }) : t("alarm.none"));
    acknowledge.disabled = active.length === 0 || Boolean(past);
    const over = history
      .filter((each) => !active.some((/** @type {any} */ one) => one.code === each.code && one.time === each.time))
      .reverse();
    fill(body, ...active.map((each) => rowOf(each, true)), ...over.map((each) => rowOf(each, false)));
  }
  endings.add(model.alarms.watch(draw), model.moment.watch(draw));
}

/**
 * @param {any} alarm
 * @param {boolean} isActive
 */
function rowOf(alarm, isActive) {
  const time = String(alarm.time ?? "")
    .replace("T", " ")
    .slice(0, 19); // local time of the machine
  return h(
    "tr",
    { className: isActive ? "is-alarm" : "" },
    h("td.number", {}, time),
    h("td.number", {}, `${isActive ? "\u26a0 " : ""}${alarm.code}`),
    h("td", {}, alarm.text, alarm.effect ? h("div.hint", {}, alarm.effect) : ""),
  );
}
