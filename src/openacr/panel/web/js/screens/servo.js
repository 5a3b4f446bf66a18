// SERVO LOOP: every parameter of the loop of one axis, live.
import { model, refuse } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { watchTable } from "../frame/watch_table.js";

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "servo.title",
  area: "full",
  async show({ body, endings }) {
    let chosen = model.axes[0]?.index ?? 0;
    const axes = h("div.row.wrap", { role: "radiogroup", ariaLabel: t("form.axis") });
    const host = h("div.fact-groups", {});
    body.append(axes, host);
    const show = watchTable(host, endings, (parameter) => !parameter.section.startsWith("Flag"));
    const choose = (/** @type {number} */ index) => {
      chosen = index;
      fill(axes, ...model.axes.map((axis) => h("button.key", { type: "button", role: "radio", ariaChecked: String(axis.index === chosen), onclick: () => choose(axis.index) }, axis.name)));
      /** @type {HTMLElement | null} */ (axes.querySelector("[aria-checked=true]"))?.focus();
      return show({ object: "AXIS", index: chosen }).catch(refuse);
    };
    await choose(chosen);
  },
};
