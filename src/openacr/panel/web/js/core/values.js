// Parameters of the card: each screen names those it shows; one subscription fetches them all.
import { link, model } from "./app.js";

const HZ = 5;
const MOST = 256; // of one subscription: the screen opened last comes first

/**
 * @typedef {(values: Map<number, number>) => void} Show
 */

/** @type {{ numbers: number[], show: Show }[]} */
const shown = [];
/** @type {Map<number, number>} */
const values = new Map();
/** @type {number[]} */
let parameters = [];
let end = () => {};

model.watched.watch((pairs) => {
  for (const [place, value] of pairs) if (place < parameters.length) values.set(parameters[place], value);
  if (pairs.length) for (const each of shown) each.show(values);
});

/**
 * Have parameters sent; `show` gets all known values when some have changed. Returns the function that ends it.
 * @param {number[]} numbers
 * @param {Show} show
 */
export function needValues(numbers, show) {
  const need = { numbers, show };
  shown.unshift(need);
  subscribe();
  return () => {
    shown.splice(shown.indexOf(need), 1);
    subscribe();
  };
}

function subscribe() {
  end();
  values.clear();
  parameters = [...new Set(shown.flatMap((each) => each.numbers))].slice(0, MOST);
  end = parameters.length ? link.subscribe({ topic: "watch", hz: HZ, parameters }) : () => {};
}
