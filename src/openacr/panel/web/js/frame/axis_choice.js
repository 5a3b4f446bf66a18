// A check for each axis, and one for all.
import { model } from "../core/app.js";
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";

/**
 * @param {{ label: string, isOn?: (axis: import("../core/model.js").Axis) => boolean,
 *   extra?: (axis: import("../core/model.js").Axis) => HTMLElement | string }} options
 */
export function axisChoice({ label, isOn = () => false, extra = () => "" }) {
  const boxes = model.axes.map((axis) => ({ axis, box: h("input", { type: "checkbox", checked: isOn(axis) }) }));
  const all = h("input", {
    type: "checkbox",
    onchange: () =>
      boxes.forEach(({ box }) => {
        box.checked = all.checked;
      }),
  });
  const follow = () => {
    all.checked = boxes.every(({ box }) => box.checked);
  };
  boxes.forEach(({ box }) => box.addEventListener("change", follow));
  follow();
  const element = h(
    "fieldset.axis-choice",
    {},
    h("legend", {}, label),
    h("label.check", {}, all, h("strong", {}, t("axes.all"))),
    ...boxes.map(({ axis, box }) =>
      h("div.row", {}, h("label.check.grow", {}, box, h("strong.axis-name", {}, axis.name)), extra(axis)),
    ),
  );
  return {
    element,
    names: () =>
      boxes
        .filter(({ box }) => box.checked)
        .map(({ axis }) => axis.name)
        .join(""),
  };
}
