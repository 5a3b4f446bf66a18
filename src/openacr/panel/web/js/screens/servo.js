// SERVO LOOP: the loop of one axis as a drawing with live values.
import { model } from "../core/app.js";
import { cardAxes } from "../core/card_axes.js";
import { fill, h, setText } from "../core/dom.js";
import { needWords, stateOf, wordsOf } from "../core/flags.js";
import { Endings } from "../core/signal.js";
import { t } from "../core/texts.js";
import { needValues } from "../core/values.js";
import { PLACES, drawLoop } from "../draw/loop.js";

const TEXTS = {
  label: { en: "Servo loop of axis {axis}", de: "Regelkreis der Achse {axis}" },
  open: { en: "Loop open", de: "Regelkreis offen" },
  closed: { en: "Loop closed", de: "Regelkreis geschlossen" },
  filtering: { en: "filters on", de: "Filter ein" },
  bypassed: { en: "filters off", de: "Filter aus" },
};

const [FIRST, EACH] = [12288, 256]; // parameters of axis 0, distance to those of the next axis
const [OPEN, FILTER, FLAGS] = [785, 786, 32]; // flags of axis 0: open servo loop, filter active

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "servo.title",
  help: {
    en: "The whole loop of one axis, live: setpoints, gains, the terms they give, filters, output.",
    de: "Der ganze Regelkreis einer Achse, laufend: Sollwerte, Verstärkungen, ihre Anteile, Filter, Ausgang.",
  },
  area: "full",
  async show({ body, endings }) {
    const own = new Endings();
    endings.add(() => own.end());
    const axes = h("div.row.wrap", { role: "radiogroup", ariaLabel: t("form.axis") });
    const state = h("span.hint.grow", { role: "status" });
    const host = h("div.loop-host.grow", { tabIndex: 0, role: "group", ariaLabel: t("servo.title") });
    body.append(h("div.row.wrap", {}, axes, state), host);
    const choose = (/** @type {number} */ index) => {
      own.end();
      const name = all.find((axis) => axis.index === index)?.title ?? "";
      fill(
        axes,
        ...all.map((axis) =>
          h(
            "button.key",
            {
              type: "button",
              role: "radio",
              ariaChecked: String(axis.index === index),
              onclick: () => choose(axis.index),
            },
            axis.title,
          ),
        ),
      );
      const picture = drawLoop(t(TEXTS.label, { axis: name }));
      fill(host, picture.element);
      const first = FIRST + EACH * index;
      const flags = [OPEN + FLAGS * index, FILTER + FLAGS * index];
      own.add(
        needValues(
          PLACES.map((place) => first + place),
          (values) => picture.update((place) => values.get(first + place)),
        ),
        needWords(wordsOf(flags)),
        model.flags.watch((words) => {
          const [isOpen, isFiltering] = flags.map((flag) => stateOf(words, flag));
          setText(
            state,
            [
              isOpen === undefined ? "" : t(isOpen ? TEXTS.open : TEXTS.closed),
              isFiltering === undefined ? "" : t(isFiltering ? TEXTS.filtering : TEXTS.bypassed),
            ]
              .filter(Boolean)
              .join(" \u00b7 "),
          );
          picture.element.classList.toggle("is-bypassed", isFiltering === false);
        }),
      );
      /** @type {HTMLElement | null} */ (axes.querySelector("[aria-checked=true]"))?.focus();
    };
    const all = await cardAxes();
    choose(all[0]?.index ?? 0);
  },
};
