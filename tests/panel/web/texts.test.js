// Texts of the screens: in every language alike, each one used, and none asked for that does not exist.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { test } from "node:test";
import bench from "../../../src/openacr/panel/web/js/catalog/bench.js";
import operator from "../../../src/openacr/panel/web/js/catalog/operator.js";
import { t, textOr } from "../../../src/openacr/panel/web/js/core/texts.js";

const JS = new URL("../../../src/openacr/panel/web/js/", import.meta.url);
const STRING = String.raw`"((?:[^"\\]|\\.)*)"`;
const KEY = String.raw`"([a-z][A-Za-z0-9 ]*(?:\.[A-Za-z0-9_ -]+)+)"`;
const SUM = String.raw`(${STRING}(?:\s*\+\s*${STRING})*)`;
const PAIR = new RegExp(String.raw`\{\s*en:\s*(?<en>${SUM}),\s*de:\s*(?<de>${SUM}),?\s*\}`, "g");
const OWN = new RegExp(String.raw`(\w+):\s*\{\s*en:\s*"`, "g");

const sources = new Map(
  readdirSync(JS, { recursive: true })
    .filter((name) => name.endsWith(".js"))
    .map((name) => [name.replaceAll("\\", "/"), readFileSync(new URL(name, JS), "utf8")]),
);
const modules = [...sources].filter(([name]) => !name.startsWith("catalog/"));
const commands = JSON.parse(process.env.TITLES ?? "[]"); // names of the commands that have a title
const keys = new Set([...Object.keys(operator), ...Object.keys(bench)]);
const found = (pattern) =>
  new Set(modules.flatMap(([, source]) => [...source.matchAll(new RegExp(pattern, "g"))].map((match) => match[1])));

test("every text has both languages, with the same places for values", () => {
  let count = 0;
  for (const [name, source] of sources) {
    if (name === "core/texts.js") continue;
    const pairs = [...source.matchAll(PAIR)];
    assert.equal(pairs.length, source.match(/\ben:/g)?.length ?? 0, name);
    count += pairs.length;
    for (const { groups } of pairs) {
      const { en: english, de: german } = groups;
      const places = (text) => (text.match(/\{\w+\}/g) ?? []).sort();
      assert.deepEqual(places(german), places(english), `${name}: ${english}`);
      assert.ok(english !== '""' && german !== '""', name);
    }
  }
  assert.ok(count > 850);
});

test("every key that is asked for is in a catalogue, and in one alone", () => {
  const asked = [...found(String.raw`\bt\(\s*${KEY}`), ...found(String.raw`\b(?:title|label): ${KEY}`)];
  assert.ok(asked.length > 250);
  assert.deepEqual(
    asked.filter((key) => !keys.has(key) && !commands.includes(key)),
    [],
  );
  assert.deepEqual(
    commands.filter((name) => keys.has(name)),
    [],
  );
  assert.equal(keys.size, Object.keys(operator).length + Object.keys(bench).length);
});

test("every key of the catalogues is asked for, as it is or by how it begins", () => {
  const used = found(KEY);
  const made = [...found(String.raw`\`([a-z][\w. ]*\.)\$\{`), ...found(String.raw`"([a-z][\w.]*\.)"`)];
  assert.deepEqual(
    [...keys].filter((key) => !used.has(key) && !made.some((start) => key.startsWith(start))),
    [],
  );
});

test("every title of a command is asked for", () => {
  const used = found(KEY);
  assert.ok(commands.length > 15);
  assert.deepEqual(
    commands.filter((name) => !used.has(name)),
    [],
  );
});

test("every text that a module has for itself is said there", () => {
  const all = modules.map(([, source]) => source).join("\n");
  for (const [name, source] of modules) {
    const isChosen = /TEXTS\)?\[/.test(source); // by a name that comes at run time: of a lane, a state
    const isNamed = (own) => isChosen && (all.match(new RegExp(String.raw`\b${own}\b`, "g")) ?? []).length > 1;
    for (const [, own] of source.matchAll(OWN)) {
      const isUsed =
        ["title", "label", "help", "past"].includes(own) ||
        new RegExp(String.raw`\bTEXTS\.${own}\b`).test(source) ||
        isNamed(own);
      assert.ok(isUsed, `${name}: ${own}`);
    }
  }
});

test("a text is said with its values, a count with the word that fits it", () => {
  const text = { en: "{count} {count|line|lines} of {name}", de: "{name}" };
  assert.equal(t(text, { count: 1, name: "a.nc" }), "1 line of a.nc");
  assert.equal(t(text, { count: 0, name: "a.nc" }), "0 lines of a.nc");
  assert.equal(t(text, { count: 12 }), "12 lines of ");
  assert.equal(t("key.ok"), "OK");
  assert.equal(textOr("key.none", "as it is"), "as it is");
});

test("texts and titles are in the chosen language, in another than those known in English", async () => {
  const titles = { "home.start": { en: "START HOME", de: "REFERENZFAHRT STARTEN" } };
  const element = { getAttribute: () => JSON.stringify(titles) };
  globalThis.document = { documentElement: {}, querySelector: () => element };
  const texts = await import("../../../src/openacr/panel/web/js/core/texts.js?another");
  const text = { en: "none", de: "keine" };
  texts.useLanguage("de");
  assert.equal(texts.t(text), "keine");
  assert.equal(texts.t("key.cancel"), operator["key.cancel"].de);
  assert.equal(texts.t("home.start"), titles["home.start"].de);
  texts.useLanguage("en");
  texts.useLanguage("fr");
  assert.deepEqual([texts.t(text), document.documentElement.lang], ["none", "fr"]);
});
