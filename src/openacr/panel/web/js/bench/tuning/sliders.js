// Gains of one axis as sliders that act at once, with a list of changes to go back and forth in.
import { give, link, refuse, report } from "../../core/app.js";
import { gainRows } from "../../core/card_axes.js";
import { evaluate } from "../../core/arithmetic.js";
import { fill, h } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { t } from "../../core/texts.js";
import { History } from "./history.js";

const TEXTS = {
  back: { en: "BACK TO THIS", de: "HIERHER ZURÜCK" },
  backTo: {
    en: "Back to {name} {value} and all gains as then",
    de: "Zurück zu {name} {value} und allen Werten wie damals",
  },
  wentBack: { en: "The gains are as they were then", de: "Die Werte sind wie damals" },
};
const DECADES = 1; // to both sides of the value at the start
const STEPS = 100; // of a decade

/**
 * A gain: its value on the card, the one that the list of changes ends with, and the one in the middle of its slider.
 * @typedef {{ name: string, value: number, listed: number, base: number, field: HTMLInputElement,
 *   slider: HTMLInputElement | null }} Gain
 */

/**
 * Show the sliders of an axis in an element; `reload` reads all gains of the card anew, as after a proposal was set.
 * @param {HTMLElement} host
 * @param {import("../../core/card_axes.js").CardAxis} axis
 * @param {() => boolean} isStored whether a gain is also kept in the parameters of the machine, once its slider is let
 *   go
 */
export async function gainSliders(host, axis, isStored) {
  const history = new History();
  /** @type {Map<string, Gain>} */
  const gains = new Map();
  const list = h("ol.tune-changes.scroll", { ariaLabel: t("tune.changes") });
  const [undo, redo, start] = [
    keyOf("tune.undo", () => back(history.undo(), "before"), "", { disabled: true }),
    keyOf("tune.redo", () => back(history.redo(), "after"), "", { disabled: true }),
    keyOf("tune.start", toStart, "", { disabled: true }),
  ];
  const rows = h("div.stack", {});
  fill(host, h("div.notice", {}, t("gain.warning")), rows, h("div.row.wrap", {}, undo, redo, start), list);

  async function reload() {
    const [found, values] = await Promise.all([gainRows(axis), link.command("tune.gains", { axis: axis.name })]);
    const shown = found.filter((row) => row.name in values);
    fill(rows, ...shown.map((/** @type {any} */ row) => rowOf(row, values[row.name])));
  }

  /**
   * @param {import("../../frame/field.js").FormRow} row
   * @param {number} value
   */
  function rowOf(row, value) {
    const known = gains.get(row.name);
    const base = known?.base || value;
    const field = h("input.field.number", { id: `tune-${row.number}`, inputMode: "decimal", autocomplete: "off" });
    const slider =
      base === 0
        ? null
        : h("input.grow", {
            type: "range",
            min: String(-DECADES * STEPS),
            max: String(DECADES * STEPS),
            ariaLabel: t("tune.slider", { gain: row.name }),
          });
    /** @type {Gain} */
    const gain = { name: row.name, value, listed: known?.listed ?? value, base, field, slider };
    gains.set(row.name, gain);
    shows(gain);
    listed(gain);
    const place = () => Number((base * 10 ** (Number(slider?.value) / STEPS)).toPrecision(4));
    const acts = latest((wanted) => send(gain, wanted, false));
    slider?.addEventListener("input", () => void acts(place()));
    slider?.addEventListener("change", async () => {
      await acts(place());
      if (isStored()) await send(gain, place());
      listed(gain);
    });
    const enter = async (/** @type {Event} */ event) => {
      event.preventDefault();
      const wanted = evaluate(field.value);
      if (wanted === null) return refuse(`${row.name}: ${t("pad.none")}`);
      await send(gain, wanted);
      listed(gain);
    };
    return h(
      "form.tune-gain",
      { onsubmit: enter, data: { gain: row.name } },
      h("label", { htmlFor: field.id, title: row.help }, row.name),
      slider ?? h("span.grow.quiet", {}, t("tune.zero")),
      field,
      h("span.unit", {}, row.unit),
    );
  }

  /**
   * Set a gain on the card; a value that is refused leaves it as it was.
   * @param {Gain} gain
   * @param {number} value
   * @param {boolean} [store]
   */
  async function send(gain, value, store = isStored()) {
    const answer = await give("gain.set", { axis: axis.name, gain: gain.name, value, store });
    if (answer) gain.value = answer.value;
    shows(gain);
  }

  /**
   * Add what has become of a gain to the list of changes.
   * @param {Gain} gain
   */
  function listed(gain) {
    history.note(gain.name, gain.listed, gain.value);
    gain.listed = gain.value;
    drawHistory();
  }

  /**
   * @param {{ name: string, before?: number, after?: number } | undefined} change
   * @param {"before" | "after"} which
   */
  async function back(change, which) {
    const gain = change && gains.get(change.name);
    if (gain) {
      await send(gain, change[which] ?? gain.value);
      gain.listed = gain.value;
    }
    drawHistory();
  }

  async function toStart() {
    for (const [name, value] of history.atStart()) {
      const gain = gains.get(name);
      if (!gain) continue;
      await send(gain, value);
      listed(gain);
    }
    report(t("tune.started"));
  }

  /**
   * The set of gains after a change of the list; REDO goes forward again.
   * @param {number} count of changes that are left
   */
  async function backTo(count) {
    for (const [name, value] of history.backTo(count)) await back({ name, before: value }, "before");
    report(t(TEXTS.wentBack));
  }

  function drawHistory() {
    undo.disabled = history.done.length === 0;
    redo.disabled = history.undone.length === 0;
    start.disabled = history.done.length === 0;
    fill(
      list,
      ...history.done.map(({ name, before, after, at }, n) =>
        h(
          "li",
          {},
          h("time.quiet", {}, at.toLocaleTimeString()),
          ` ${name}: ${before} \u2192 ${after} `,
          n + 1 < history.done.length
            ? keyOf(TEXTS.back, () => void backTo(n + 1), "", { ariaLabel: t(TEXTS.backTo, { name, value: after }) })
            : "",
        ),
      ),
    );
  }

  await reload();
  drawHistory();
  return { reload };
}

/** @param {Gain} gain */
function shows({ value, base, field, slider }) {
  field.value = String(value);
  if (slider) slider.value = String(Math.round(Math.log10(value / base) * STEPS));
}

/**
 * A function that carries out the newest of the values it is called with, one after the other.
 * @param {(value: number) => Promise<unknown>} act
 * @returns {(value: number) => Promise<void>}
 */
function latest(act) {
  /** @type {number | null} */
  let wanted = null;
  let running = Promise.resolve();
  const run = async () => {
    if (wanted === null) return;
    const value = wanted;
    wanted = null;
    await act(value);
  };
  return (value) => {
    wanted = value;
    running = running.then(run);
    return running;
  };
}
