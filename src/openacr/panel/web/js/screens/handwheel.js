// HANDWHEEL: choose the axes that the wheel moves.
import { give } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { t } from "../core/texts.js";
import { axisChoice } from "../frame/axis_choice.js";
import { mayMove } from "../motion/actions.js";

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "handwheel.title",
  mode: "manual",
  show({ body, endings }) {
    const choice = axisChoice({ label: t("handwheel.axes") });
    const state = h("div.notice", { role: "status", hidden: true });
    const turn = async (/** @type {string} */ axes) => {
      if (await give("handwheel", { axes })) {
        state.hidden = !axes;
        setText(state, t("handwheel.on", { axes: axes.split("").join(" ") }));
      }
    };
    body.append(h("p", {}, t("handwheel.text")), choice.element, h("div.row", {},
      h("button.key.big.main", { type: "button", onclick: () => mayMove() && turn(choice.names()) }, t("handwheel.start")),
      h("button.key.big", { type: "button", onclick: () => turn("") }, t("handwheel.end"))), state);
    endings.add(() => {
      if (!state.hidden) void give("handwheel", { axes: "" });
    });
  },
};
