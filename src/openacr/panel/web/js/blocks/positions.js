// Positions: the work position large, machine position and distance to go beside it.
import { model, refuse, report, give } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { position } from "../core/format.js";
import { viewOf } from "../core/units.js";
import { t } from "../core/texts.js";
import { askNumber } from "../frame/number_pad.js";

const USED = 0.9; // share of the travel from which on a position is marked

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export function positionBlock(panel, endings) {
  const { axes, is_small: isSmall } = model.hello.value.machine;
  const rows = axes.map((axis, n) => rowOf(axis, n));
  panel.append(
    h(
      "section.block.positions",
      { ariaLabel: t("block.position"), data: { axes: String(axes.length), size: isSmall ? "small" : "big" } },
      ...rows.map((row) => row.element),
    ),
  );
  endings.add(model.status.watch((status) => status && rows.forEach((row) => row.draw(status))));
  endings.add(model.state.watch((state) => rows.forEach((row) => row.home(state.homed ?? []))));
}

/**
 * @param {import("../core/model.js").Axis} axis
 * @param {number} n
 */
function rowOf(axis, n) {
  const { unit, decimals, factor } = viewOf(axis);
  const name = h("span.axis-name", {}, axis.name, h("small", {}, unit));
  const work = h("span.work-value.live", {}, "\u2013");
  const [machine, toGo] = [
    h("span.number.live", { title: t("position.machine") }),
    h("span.number.live", { title: t("position.togo") }),
  ];
  const sign = h("span.axis-sign", {});
  const travel = h("span.travel", { ariaHidden: "true" }, h("i", {}));
  const key = h(
    "button.work-key",
    { type: "button", title: t("position.set", { axis: axis.name }), onclick: () => setWork(axis) },
    name,
    work,
  );
  const element = h(
    "div.position-row",
    { data: { axis: axis.name } },
    key,
    h("div.position-more", {}, machine, toGo, travel),
    sign,
  );
  const hasTravel = axis.low !== null && axis.high !== null && axis.high > axis.low;
  travel.hidden = !hasTravel;
  return {
    element,
    /** @param {import("../core/frames.js").Status} status */
    draw(status) {
      setText(work, position(status.work[n] * factor, decimals));
      setText(machine, position(status.machine[n] * factor, decimals));
      setText(toGo, position(status.toGo[n] * factor, decimals));
      const isAtLimit = (status.limit >> n) & 1;
      const isMoving = (status.jogging >> n) & 1;
      element.classList.toggle("is-limit", Boolean(isAtLimit));
      element.classList.toggle("is-jogging", Boolean(isMoving));
      if (!hasTravel) return;
      const share = (status.machine[n] - Number(axis.low)) / (Number(axis.high) - Number(axis.low));
      const mark = /** @type {HTMLElement} */ (travel.firstChild);
      mark.style.left = `${Math.min(100, Math.max(0, share * 100))}%`;
      travel.classList.toggle("is-near", share > USED || share < 1 - USED);
    },
    /** @param {string[]} homed */
    home(homed) {
      const isHomed = homed.includes(axis.name);
      setText(sign, isHomed ? "\u2302" : axis.home_required ? "\u2302?" : "");
      sign.title = isHomed ? t("position.homed") : t("position.nothomed");
      sign.classList.toggle("is-missing", !isHomed);
    },
  };
}

/**
 * Touching a position sets the work offset, so that the axis reads the entered value.
 * @param {import("../core/model.js").Axis} axis
 */
async function setWork(axis) {
  if (model.state.value.busy) {
    refuse(t("position.busy"));
    return;
  }
  const { unit, factor } = viewOf(axis);
  const value = await askNumber({
    title: t("position.set", { axis: axis.name }),
    value: 0,
    unit,
    hint: t("position.hint"),
  });
  if (value !== null && (await give("zero.preset", { values: { [axis.name]: value / factor } })))
    report(t("position.done", { axis: axis.name }));
}

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export function distanceBlock(panel, endings) {
  simpleBlock(panel, endings, t("block.distance"), (status) => status.toGo);
}

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export function nextBlock(panel, endings) {
  simpleBlock(panel, endings, t("block.next"), (status) => status.next);
}

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 * @param {string} title
 * @param {(status: import("../core/frames.js").Status) => Float64Array} values
 */
function simpleBlock(panel, endings, title, values) {
  const cells = model.axes.map((axis) => ({ axis, ...viewOf(axis), value: h("span.number.live", {}, "\u2013") }));
  panel.append(
    h(
      "section.block",
      { ariaLabel: title },
      h("h3", {}, title),
      h(
        "div.simple-positions",
        {},
        ...cells.map(({ axis, value, unit }) =>
          h(
            "div.simple-row",
            { data: { axis: axis.name } },
            h("strong", {}, axis.name),
            value,
            h("span.quiet", {}, unit),
          ),
        ),
      ),
    ),
  );
  endings.add(
    model.status.watch(
      (status) =>
        status &&
        cells.forEach(({ value, decimals, factor }, n) =>
          setText(value, position(values(status)[n] * factor, decimals)),
        ),
    ),
  );
}
