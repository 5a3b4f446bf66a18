// What the card's aliases and the machine call flags and parameters, by BIT36 and P12290.
import { get } from "./api.js";

/** The names that the machine gives inputs and outputs. @returns {Promise<Record<string, string>>} */
export async function lineNames() {
  const { inputs, outputs } = await get("io").catch(() => ({ inputs: [], outputs: [] }));
  return Object.fromEntries(
    [...inputs, ...outputs]
      .filter((/** @type {{ name: string }} */ { name }) => name)
      .map((/** @type {{ bit: number, name: string }} */ each) => [`BIT${each.bit}`, each.name]),
  );
}

/** Aliases of #DEFINE, else names of the machine; of a card that cannot be asked no aliases. */
export async function ownNames() {
  const [lines, { aliases }] = await Promise.all([
    lineNames(),
    get("card/aliases").catch(() => ({ aliases: /** @type {Record<string, string>} */ ({}) })),
  ]);
  return { ...lines, ...aliases };
}
