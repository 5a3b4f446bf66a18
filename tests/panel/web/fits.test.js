// How well texts fit the words that are looked for.
import assert from "node:assert/strict";
import test from "node:test";
import { misfit } from "../../../src/openacr/panel/web/js/core/fits.js";

/**
 * @param {string} wanted
 * @param {string[]} texts
 */
const ranked = (wanted, texts) =>
  texts
    .map((text) => ({ text, cost: misfit(text, wanted) }))
    .filter(({ cost }) => cost !== null)
    .sort((one, other) => Number(one.cost) - Number(other.cost))
    .map(({ text }) => text);

test("a word at its beginning is before one inside, and that before letters in their order", () => {
  const texts = ["Server poll spread", "Soft open", "Unscope", "Scope", "Timeline"];
  assert.deepEqual(ranked("scope", texts), ["Scope", "Unscope"]);
  assert.deepEqual(ranked("sope", ["Soft open", "Scope"]), ["Scope", "Soft open"]);
});

test("all words have to fit, in any order", () => {
  assert.equal(misfit("Actual Position", "position velocity"), null);
  assert.equal(misfit("Actual Position", "pos act"), misfit("Actual Position", "act pos"));
});

test("of texts that fit alike the shortest is first", () => {
  assert.deepEqual(ranked("tun", ["Tuning of axes", "Tuning"]), ["Tuning", "Tuning of axes"]);
});

test("accents, soft hyphens and points do not matter", () => {
  assert.notEqual(misfit("Verst\u00e4rkungen", "verstark"), null);
  assert.notEqual(misfit("REFER\u00adENCE", "reference"), null);
  assert.equal(misfit("card.halt", "halt"), misfit("card halt", "halt"));
});

test("letters that are far apart, or do not begin a word, are no abbreviation", () => {
  assert.notEqual(misfit("Terminal", "tml"), null);
  assert.equal(misfit("Terminal", "rml"), null);
  assert.equal(misfit("t 234567m", "tm"), null);
  assert.notEqual(misfit("t 23456m", "tm"), null);
});
