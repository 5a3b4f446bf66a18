// HOME: choose axes, start, and see how far each one is.
import { give, model, refuse } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t, textOr } from "../core/texts.js";
import { axisChoice } from "../frame/axis_choice.js";
import { mayMove } from "../motion/actions.js";

const TEXTS = {
  text: {
    en: "The axes move to their switches: clear the table. Order by priority.",
    de: "Die Achsen fahren zu ihren Schaltern: Tisch freimachen. Reihenfolge nach Priorität.",
  },
  axes: { en: "Axes to be homed", de: "Achsen" },
  progress: { en: "Homing is in progress: {reason}", de: "Die Referenzfahrt läuft: {reason}" },
  homed: { en: "homed", de: "referenziert" },
  nothomed: { en: "not homed", de: "nicht referenziert" },
};

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "Home", de: "Referenzfahrt" },
  mode: "home",
  show({ body, endings }) {
    /** @type {Map<string, HTMLElement>} */
    const states = new Map();
    const choice = axisChoice({
      label: t(TEXTS.axes),
      isOn: () => true,
      extra: (axis) => {
        const state = h("span.home-state", {}, "");
        states.set(axis.name, state);
        return state;
      },
    });
    const start = keyOf(
      "home.start",
      async () => {
        const axes = choice.names();
        if (!axes) refuse(t("axes.none"));
        else if (mayMove()) await give("home.start", { axes });
      },
      ".big.danger",
    );
    const stop = keyOf("menu.stop", () => give("stop.hold"), ".big.bad");
    const progress = h("div.notice", { role: "status" });
    body.append(h("p", {}, t(TEXTS.text)), choice.element, h("div.row", {}, h("div.grow", {}, start), stop), progress);
    endings.add(
      model.home.watch(({ axes }) =>
        axes.forEach((each) => {
          const element = states.get(each.name);
          if (!element) return;
          const text = each.homed
            ? `\u2302 ${t(TEXTS.homed)}`
            : each.state
              ? textOr(`home.state.${each.state}`, each.state)
              : t(TEXTS.nothomed);
          setText(element, text);
          element.classList.toggle("is-homed", each.homed);
        }),
      ),
      model.state.watch((state) => {
        const isHoming = state.state === "HOMING";
        stop.hidden = !isHoming;
        start.disabled = state.busy;
        progress.hidden = !isHoming;
        setText(progress, isHoming ? t(TEXTS.progress, { reason: state.reason || "" }) : "");
      }),
    );
  },
};
