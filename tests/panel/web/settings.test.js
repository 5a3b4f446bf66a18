// Texts of the settings in German: every one, with its numbers; and why a value is refused.
import assert from "node:assert/strict";
import { test } from "node:test";
import german, { REASONS } from "../../../src/openacr/panel/web/js/catalog/settings_de.js";
import {
  loadSettingTexts,
  refusalText,
  searchedTexts,
  settingText,
} from "../../../src/openacr/panel/web/js/core/settings_texts.js";
import { useLanguage } from "../../../src/openacr/panel/web/js/core/texts.js";

const shown = JSON.parse(process.env.SETTINGS ?? "[]"); // texts of all forms, with {} for numbers
const refused = JSON.parse(process.env.REFUSALS ?? "[]");
const SAME_IN_BOTH = /^[A-Z0-9/#.,+{} -]*$|^(rs\{\}ngc|hardware|software|auto|acromill|mm)$/;
globalThis.document ??= /** @type {any} */ ({ documentElement: {} });

test("every text of a form has a German one, and none is without a use", async () => {
  assert.ok(shown.length > 300);
  const missing = shown.filter((key) => !(key in german) && !SAME_IN_BOTH.test(key));
  assert.deepEqual(missing, []);
  assert.deepEqual(
    Object.keys(german).filter((key) => !shown.includes(key)),
    [],
  );
  const places = (text) => text.split("{}").length;
  for (const [english, said] of Object.entries({ ...german, ...REASONS }))
    assert.equal(places(said), places(english), english);
});

test("in English the texts are as they came, in German with their numbers", async (context) => {
  const [name, reason] = [
    "Message 12 text colour",
    "P200001 P Gain (axis 0) cannot be 'x': any number [V] (Volts per pulse of error.)",
  ];
  await loadSettingTexts();
  assert.equal(settingText(name), name);
  assert.equal(refusalText(reason), reason);
  useLanguage("de");
  context.after(() => useLanguage("en"));
  await loadSettingTexts();
  assert.equal(settingText(name), "Textfarbe von Meldung 12");
  assert.equal(settingText("Offset of G59.1."), "Verschiebung von G59.1.");
  assert.deepEqual(searchedTexts("nullmarkens"), ["nullmarkens", "Marker Speed", "Replaces Marker Speed of HOME,"]);
  assert.equal(
    settingText("Probe Input 3 of somewhere"),
    "Probe Input 3 of somewhere", // a text that is not known stays
  );
  assert.equal(
    refusalText(reason),
    "P200001 P-Verstärkung (Achse 0) kann nicht 'x' sein: eine Zahl [V] (Volt je Impuls Schleppfehler.)",
  );
  assert.equal(
    refusalText("P250001 Default Units cannot be 7: one of 0 (inch), 1 (mm)"),
    "P250001 Grundeinheit kann nicht 7 sein: eines von 0 (Zoll), 1 (mm)",
  );
  assert.ok(refused.length > 8);
  const english = /\b(cannot|be|of the|from|number|above|already|one of|is|has|or)\b/;
  assert.deepEqual(
    refused.map(refusalText).filter((text) => english.test(text)),
    [],
  );
});
