// SERVO LOOP: the loop of one axis as a chain of blocks with its numbers.
import { get } from "../core/api.js";
import { model, refuse } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { groupOf } from "../frame/facts_screen.js";

const EVERY_MS = 300;

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "servo.title",
  area: "full",
  async show({ body, endings }) {
    let chosen = model.axes[0]?.name ?? "X";
    const axes = h("div.row.wrap", { role: "radiogroup", ariaLabel: t("form.axis") });
    const chain = h("div.loop", {});
    body.append(axes, chain);
    const keys = () => fill(axes, ...model.axes.map((axis) => h("button.key", { type: "button", role: "radio", ariaChecked: String(axis.name === chosen), onclick: () => {
      chosen = axis.name;
      keys();
      void draw();
    } }, axis.name)));
    const draw = async () => {
      try {
        const { groups } = await get("card/loop", { axis: chosen });
        fill(chain, ...groups.flatMap((/** @type {any} */ group, /** @type {number} */ n) => [n ? h("span.loop-arrow", { ariaHidden: "true" }, "\u2192") : "", h("div.loop-block", {}, groupOf(group))]));
      } catch (error) {
        refuse(error);
      }
    };
    keys();
    await draw();
    const timer = setInterval(draw, EVERY_MS);
    endings.add(() => clearInterval(timer));
  },
};
