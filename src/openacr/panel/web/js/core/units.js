// The unit of the read-out: inch or mm, whatever unit the machine has. Degrees stay degrees.
import { model } from "./app.js";
import { keepSetting, setting } from "./settings.js";
import { Signal } from "./signal.js";

const MM_PER_INCH = 25.4;
const NAME = "unit";

/** "mm", "inch", or "" for the Control Mode of the machine (DISPLAY tab). */
export const chosenUnit = new Signal(setting(NAME, ""));

/** @param {string} unit */
export function chooseUnit(unit) {
  keepSetting(NAME, unit);
  chosenUnit.set(unit);
}

/** The unit of lengths in the read-out. */
export function shownUnit() {
  return chosenUnit.value || model.hello.value.machine.shown;
}

/** Shown units in one unit of the machine. */
export function lengthFactor() {
  const [of, shown] = [model.hello.value.machine.unit, shownUnit()];
  return of === shown ? 1 : shown === "mm" ? MM_PER_INCH : 1 / MM_PER_INCH;
}

/**
 * How an axis is shown: its unit, its decimals, and the factor from the unit of the machine.
 * @param {import("./model.js").Axis} axis
 */
export function viewOf(axis) {
  const isLength = axis.unit !== "deg";
  const shown = shownUnit();
  return {
    unit: isLength ? shown : axis.unit,
    decimals: axis.decimals[/** @type {"mm" | "inch"} */ (shown)],
    factor: isLength ? lengthFactor() : 1,
  };
}
