// TEACH: the machine position becomes the origin of a work coordinate system.
import { give, model, refuse, report } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { position } from "../core/format.js";
import { viewOf } from "../core/units.js";
import { t } from "../core/texts.js";
import { axisChoice } from "../frame/axis_choice.js";
import { askNumber } from "../frame/number_pad.js";

const TEXTS = {
  text: {
    en: "Where the machine is becomes the origin of the system.",
    de: "Die Stelle der Maschine wird zum Nullpunkt des Systems.",
  },
  system: { en: "Work coordinate system", de: "Koordinatensystem" },
  axes: { en: "Axes, machine position", de: "Achsen, Maschinenposition" },
  done: { en: "{system}: {axes} taught", de: "{system}: {axes} übernommen" },
  lengthDone: { en: "H{h} taught", de: "H{h} übernommen" },
};

const SYSTEMS = ["G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2"];

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "Teach", de: "Teach" },
  mode: "manual",
  show({ body, endings }) {
    /** @type {HTMLElement[]} */
    const places = [];
    const system = h(
      "select.field",
      { ariaLabel: t(TEXTS.system) },
      ...SYSTEMS.map((name) => h("option", { value: name, selected: name === model.modals.value.work }, name)),
    );
    const choice = axisChoice({
      label: t(TEXTS.axes),
      extra: () => {
        const place = h("span.number.live", {});
        places.push(place);
        return place;
      },
    });
    const teach = async () => {
      const axes = choice.names();
      if (!axes) refuse(t("axes.none"));
      else if (await give("teach.work", { system: system.value, axes }))
        report(t(TEXTS.done, { system: system.value, axes: axes.split("").join(" ") }));
    };
    const length = async () => {
      const number = await askNumber({
        title: t("teach.length"),
        value: model.modals.value.H || 1,
        check: (n) => (Number.isInteger(n) && n >= 1 && n <= 999 ? "" : t("field.range", { low: 1, high: 999 })),
      });
      if (number !== null && (await give("teach.length", { h: number }))) report(t(TEXTS.lengthDone, { h: number }));
    };
    body.append(
      h("p", {}, t(TEXTS.text)),
      h("label.row", {}, h("span.grow", {}, t(TEXTS.system)), system),
      choice.element,
      h("div.row.wrap", {}, keyOf("menu.teach", teach, ".big.main"), keyOf("teach.length", length, ".big")),
    );
    endings.add(
      model.status.watch(
        (status) =>
          status &&
          model.axes.forEach((axis, n) =>
            setText(places[n], position(status.machine[n] * viewOf(axis).factor, viewOf(axis).decimals)),
          ),
      ),
    );
  },
};
