// The axes of the card: those of the machine, then others that its programs move, named AXIS2 in commands. On a card
// that AcroMill has not set up all of them are others.
import { get } from "./api.js";
import { link, model } from "./app.js";

/** @typedef {import("./model.js").Axis & { title: string, isMachines: boolean }} CardAxis */

/** @returns {Promise<CardAxis[]>} */
export async function cardAxes() {
  const machines = model.hello.value.machine.lacks ? [] : model.axes;
  const own = machines.map((axis) => ({ ...axis, title: axis.name, isMachines: true }));
  const { axes } = await get("card/axes").catch(() => ({ axes: [] }));
  const others = axes
    .filter((/** @type {any} */ each) => !own.some(({ index }) => index === each.index))
    .map((/** @type {{ index: number, name: string }} */ { index, name }) => ({
      name: `AXIS${index}`,
      title: `${name} (AXIS${index})`,
      index,
      unit: "",
      decimals: { mm: 3, inch: 4 },
      low: null,
      high: null,
      home_required: false,
      isMachines: false,
    }));
  return [...own, ...others];
}

/**
 * The gains of an axis as rows of the page SERVO; values of an axis that the machine does not have are those of the
 * card.
 * @param {CardAxis} axis
 * @returns {Promise<any[]>}
 */
export async function gainRows(axis) {
  const form = await get("forms/SERVO", { axis: axis.isMachines ? axis.index : (model.axes[0]?.index ?? 0) });
  const rows = form.groups
    .flatMap((/** @type {any} */ group) => group.rows)
    .filter((/** @type {any} */ row) => row.kind === "real");
  if (axis.isMachines) return rows;
  const values = await link.command("tune.gains", { axis: axis.name });
  return rows
    .filter((/** @type {any} */ row) => row.name in values)
    .map((/** @type {any} */ row) => ({ ...row, value: values[row.name] }));
}
