// Flag words of the card: each screen names the words it shows; one subscription fetches them all.
import { link } from "./app.js";

const HZ = 10;
/** @type {Map<number, number>} */
const wanted = new Map();
let end = () => {};

/**
 * Have flag words sent; returns the function that ends it.
 * @param {number[]} words parameter numbers, e.g. 4096 for flags 0 to 31
 */
export function needWords(words) {
  for (const word of words) wanted.set(word, (wanted.get(word) ?? 0) + 1);
  subscribe();
  return () => {
    for (const word of words) {
      const count = (wanted.get(word) ?? 1) - 1;
      if (count) wanted.set(word, count);
      else wanted.delete(word);
    }
    subscribe();
  };
}

function subscribe() {
  end();
  end = wanted.size
    ? link.subscribe({ topic: "flags", hz: HZ, words: [...wanted.keys()].sort((a, b) => a - b) })
    : () => {};
}

/**
 * The state of a flag; undefined while its word has not arrived.
 * @param {Map<number, number>} words
 * @param {number} flag
 */
export function stateOf(words, flag) {
  const word = words.get(4096 + Math.floor(flag / 32));
  return word === undefined ? undefined : ((word >>> (flag % 32)) & 1) === 1;
}

/** @param {number[]} flags */
export function wordsOf(flags) {
  return [...new Set(flags.map((flag) => 4096 + Math.floor(flag / 32)))];
}
