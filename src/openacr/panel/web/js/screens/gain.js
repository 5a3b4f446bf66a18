// GAIN: the gains of one axis; ENTER writes a value to the card at once.
import { latest } from "../core/api.js";
import { give, refuse, report } from "../core/app.js";
import { cardAxes, gainRows } from "../core/card_axes.js";
import { evaluate } from "../core/arithmetic.js";
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";

const TEXTS = {
  enter: { en: "ENTER", de: "EINGABE" },
  done: { en: "{gain} is {value}", de: "{gain} ist {value}" },
  later: {
    en: "{gain} is {value}; it is stored once the machine rests",
    de: "{gain} ist {value}; gespeichert wird, sobald die Maschine ruht",
  },
};

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "Gain", de: "Reglerverstärkung" },
  async show({ body, endings }) {
    const axes = h("div.row.wrap", { role: "radiogroup", ariaLabel: t("form.axis") });
    const store = h("input", { type: "checkbox", checked: true });
    const rows = h("div.stack.grow.scroll", {});
    body.append(h("div.notice", {}, t("gain.warning")), axes, rows, h("label.check", {}, store, t("gain.store")));
    const newest = latest(endings);
    const show = async (/** @type {import("../core/card_axes.js").CardAxis} */ axis) => {
      fill(rows); // until they are read, nothing can be typed
      fill(
        axes,
        ...all.map((each) =>
          h(
            "button.key",
            { type: "button", role: "radio", ariaChecked: String(each === axis), onclick: () => show(each) },
            each.title,
          ),
        ),
      );
      try {
        const found = await newest(gainRows(axis));
        if (found) fill(rows, ...found.map((row) => rowOf(axis, row, store)));
      } catch (error) {
        refuse(error);
      }
    };
    const all = await cardAxes();
    if (all.length) await show(all[0]);
  },
};

/**
 * @param {import("../core/card_axes.js").CardAxis} axis
 * @param {import("../frame/field.js").FormRow} row
 * @param {HTMLInputElement} store
 */
function rowOf(axis, row, store) {
  const field = h("input.field.number", {
    id: `gain-${row.number}`,
    value: row.value,
    inputMode: "decimal",
    autocomplete: "off",
  });
  const enter = async (/** @type {Event} */ event) => {
    event.preventDefault();
    const value = evaluate(field.value);
    if (value === null) {
      refuse(`${row.name}: ${t("pad.none")}`);
      return;
    }
    const answer = await give("gain.set", {
      axis: axis.name,
      gain: row.name,
      value,
      store: store.checked && axis.isMachines,
    });
    if (!answer) return;
    field.value = String(answer.value);
    report(t(store.checked && !answer.is_stored ? TEXTS.later : TEXTS.done, { gain: row.name, value: answer.value }));
  };
  return h(
    "form.gain-row",
    { onsubmit: enter },
    h("label", { htmlFor: field.id, title: row.help }, row.name),
    field,
    h("span.unit", {}, row.unit),
    h("button.key", { type: "submit" }, t(TEXTS.enter)),
  );
}
