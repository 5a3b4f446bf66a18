// How well a text fits words that are looked for: the same order as the server finds parameters in.
const [INSIDE, LETTERS, LENGTH] = [3, 8, 0.01];
const WIDEST = 4; // times its length are the letters of a word spread at most

/**
 * How badly a text fits; null where it does not. Beginnings of words fit best, then parts of words, then words whose
 * letters are there in their order; of texts that fit alike the shortest is first.
 * @param {string} text
 * @param {string} wanted
 * @returns {number | null}
 */
export function misfit(text, wanted) {
  const name = ` ${plainOf(text)}`;
  let cost = LENGTH * name.length;
  for (const word of plainOf(wanted).split(" ").filter(Boolean)) {
    if (name.includes(` ${word}`)) continue;
    if (name.includes(word)) cost += INSIDE;
    else {
      const spread = spreadOf(name, word);
      if (spread === null) return null;
      cost += LETTERS + (spread - word.length) / 4;
    }
  }
  return cost;
}

/** Small letters without accents, words with one space between them. @param {string} text */
function plainOf(text) {
  return text
    .normalize("NFD")
    .replace(/[\u0300-\u036f\u00ad]/g, "")
    .toLowerCase()
    .replace(/[\s._/]+/g, " ")
    .trim();
}

/**
 * Over how many letters the letters of a word are spread in their order, from the beginning of a word on.
 * @param {string} name
 * @param {string} word
 */
function spreadOf(name, word) {
  for (let start = name.indexOf(` ${word[0]}`); start >= 0; start = name.indexOf(` ${word[0]}`, start + 1)) {
    let at = start;
    for (const letter of word) {
      at = name.indexOf(letter, at + 1);
      if (at < 0) break;
    }
    if (at >= 0 && at - start <= WIDEST * word.length) return at - start;
  }
  return null;
}
