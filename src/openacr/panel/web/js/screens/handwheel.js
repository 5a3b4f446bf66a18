// HANDWHEEL: choose the axes that the wheel moves.
import { give } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { axisChoice } from "../frame/axis_choice.js";
import { mayMove } from "../motion/actions.js";

const TEXTS = {
  text: {
    en: "The wheel moves the chosen axes until this screen is left.",
    de: "Das Rad bewegt die gewählten Achsen, bis dieser Bildschirm verlassen wird.",
  },
  axes: { en: "Axes on the wheel", de: "Achsen am Rad" },
  start: { en: "CONNECT", de: "VERBINDEN" },
  end: { en: "DISCONNECT", de: "TRENNEN" },
  on: { en: "The wheel moves {axes}", de: "Das Rad bewegt {axes}" },
};

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "Handwheel", de: "Handrad" },
  mode: "manual",
  show({ body, endings }) {
    const choice = axisChoice({ label: t(TEXTS.axes) });
    const state = h("div.notice", { role: "status", hidden: true });
    const turn = async (/** @type {string} */ axes) => {
      if (await give("handwheel", { axes })) {
        state.hidden = !axes;
        setText(state, t(TEXTS.on, { axes: axes.split("").join(" ") }));
      }
    };
    body.append(
      h("p", {}, t(TEXTS.text)),
      choice.element,
      h(
        "div.row",
        {},
        keyOf(TEXTS.start, () => mayMove() && turn(choice.names()), ".big.main"),
        keyOf(TEXTS.end, () => turn(""), ".big"),
      ),
      state,
    );
    endings.add(() => {
      if (!state.hidden) void give("handwheel", { axes: "" });
    });
  },
};
