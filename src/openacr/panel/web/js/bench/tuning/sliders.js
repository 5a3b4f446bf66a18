// Gains of one axis as sliders that act at once, above the sets of gains that it has had.
import { give, link, refuse } from "../../core/app.js";
import { gainRows } from "../../core/card_axes.js";
import { evaluate } from "../../core/arithmetic.js";
import { fill, h } from "../../core/dom.js";
import { t } from "../../core/texts.js";
import { gainSets } from "./sets.js";

const DECADES = 1; // to both sides of the value at the start
const STEPS = 100; // of a decade

/**
 * A gain: its value on the card, the one in the middle of its slider, whether that is being moved.
 * @typedef {{ name: string, value: number, base: number, field: HTMLInputElement, slider: HTMLInputElement | null,
 *   isHeld: boolean, again: (value: number) => void }} Gain
 */

/**
 * Show the sliders of an axis in an element; `refresh` reads the gains of the card anew, as after a proposal was set.
 * @param {HTMLElement} host
 * @param {import("../../core/card_axes.js").CardAxis} axis
 * @param {() => boolean} isStored whether a gain is also kept in the parameters of the machine, once its slider is let
 *   go
 */
export async function gainSliders(host, axis, isStored) {
  /** @type {Map<string, Gain>} */
  const gains = new Map();
  const [rows, past] = [h("div.stack", {}), h("div.stack", {})];
  fill(host, h("div.notice", {}, t("gain.warning")), rows, past);
  const [found, values] = await Promise.all([gainRows(axis), link.command("tune.gains", { axis: axis.name })]);
  const shown = found.filter((row) => row.name in values);
  fill(rows, ...shown.map((/** @type {any} */ row) => rowOf(row, values[row.name])));
  const sets = gainSets(past, axis, isStored, (inForce) => {
    for (const gain of gains.values()) follow(gain, inForce[gain.name]);
  });

  /**
   * Show the value that a gain has on the card, unless it is being changed here.
   * @param {Gain} gain
   * @param {number} value
   */
  function follow(gain, value) {
    const isTyped = gain.field === document.activeElement && gain.field.value !== String(gain.value);
    if (value === undefined || value === gain.value || gain.isHeld || isTyped) return;
    if (!gain.slider) return gain.again(value); // it has a middle now
    gain.value = value;
    shows(gain);
  }

  /**
   * @param {import("../../frame/field.js").FormRow} row
   * @param {number} value
   */
  function rowOf(row, value) {
    const base = value;
    const line = h("form.tune-gain", { onsubmit: enter, data: { gain: row.name } });
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
    const gain = {
      name: row.name,
      value,
      base,
      field,
      slider,
      isHeld: false,
      again: (now) => line.replaceWith(rowOf(row, now)),
    };
    gains.set(row.name, gain);
    shows(gain);
    const place = () => Number((base * 10 ** (Number(slider?.value) / STEPS)).toPrecision(4));
    const acts = latest((wanted) => send(gain, wanted, false));
    slider?.addEventListener("input", () => {
      gain.isHeld = true;
      void acts(place());
    });
    slider?.addEventListener("change", async () => {
      await acts(place());
      gain.isHeld = false;
      if (isStored()) await send(gain, place());
      await sets.refresh();
    });
    line.append(
      h("label", { htmlFor: field.id, title: row.help }, row.name),
      slider ?? h("span.grow.quiet", {}, t("tune.zero")),
      field,
      h("span.unit", {}, row.unit),
    );
    return line;

    /** @param {Event} event */
    async function enter(event) {
      event.preventDefault();
      const wanted = evaluate(field.value);
      if (wanted === null) return refuse(`${row.name}: ${t("pad.none")}`);
      await send(gain, wanted);
      await sets.refresh();
    }
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

  await sets.refresh();
  return sets;
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
