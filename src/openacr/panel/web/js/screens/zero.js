// SET ZERO: the position of chosen axes becomes 0 of the program.
import { give, refuse, report } from "../core/app.js";
import { h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { axisChoice } from "../frame/axis_choice.js";
import { ACTIONS } from "../motion/actions.js";
import { openMenu } from "../frame/menu_bar.js";

const TEXTS = {
  text: { en: "The chosen axes read 0 where they are (G92).", de: "Die gewählten Achsen zeigen hier 0 an (G92)." },
  axes: { en: "Axes", de: "Achsen" },
};

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "Set zero", de: "Null setzen" },
  show({ body }) {
    const choice = axisChoice({ label: t(TEXTS.axes) });
    body.append(
      h("p", {}, t(TEXTS.text)),
      choice.element,
      h(
        "div.row.wrap",
        {},
        keyOf(
          "menu.setzero",
          async () => {
            const axes = choice.names();
            if (!axes) refuse(t("axes.none"));
            else if (await give("zero.set", { axes })) report(t("zero.done", { axes: axes.split("").join(" ") }));
          },
          ".big.main",
        ),
        keyOf("menu.clrzero", () => ACTIONS.clearZero({ openMenu }), ".big"),
      ),
    );
  },
};
