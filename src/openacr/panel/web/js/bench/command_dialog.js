// Any command of the panel by hand: a field for each of its arguments, made from the description of the server.
import { give, report } from "../core/app.js";
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { ask } from "../frame/dialog.js";

const TEXTS = {
  give: { en: "GIVE", de: "GEBEN" },
  given: { en: "{name} was carried out", de: "{name} ist ausgef\u00fchrt" },
  unset: { en: "not given", de: "nicht angegeben" },
};

/** What belongs to a screen or a held key, not to a hand that types. */
const OF_SCREENS = /^(watch|term)\.|^jog\.(press|keep|release)$/;
const SIMPLE = ["string", "number", "integer", "boolean"];

/**
 * A schema without references, and what it is beside null.
 * @param {any} schema
 * @param {any} about the OpenAPI document
 * @returns {any}
 */
function plainSchema(schema, about) {
  const name = schema.$ref?.split("/").at(-1);
  if (name) return { ...plainSchema(about.components.schemas[name], about), default: schema.default };
  const some = schema.anyOf?.filter((/** @type {any} */ each) => each.type !== "null");
  return some?.length === 1 ? { ...plainSchema(some[0], about), default: schema.default } : schema;
}

/** @param {any} schema */
const isSimple = (schema) => Boolean(schema.enum) || SIMPLE.includes(schema.type);

/**
 * @param {any} command
 * @param {any} about
 * @returns {{ name: string, schema: any, isNeeded: boolean }[]}
 */
function argumentsOf(command, about) {
  const args = plainSchema(command.args, about);
  return Object.entries(args.properties ?? {}).map(([name, schema]) => ({
    name,
    schema: plainSchema(schema, about),
    isNeeded: (args.required ?? []).includes(name),
  }));
}

/**
 * Whether a command can be given by hand: all that it needs fits into a field.
 * @param {string} name
 * @param {any} command
 * @param {any} about
 */
export function isForHands(name, command, about) {
  return (
    !OF_SCREENS.test(name) &&
    argumentsOf(command, about).every((each) => !each.isNeeded || (each.name !== "tick" && isSimple(each.schema)))
  );
}

/**
 * Ask for the arguments and give the command; stops are given at once.
 * @param {string} name
 * @param {string} title
 * @param {any} command
 * @param {any} about
 */
export async function giveByHand(name, title, command, about) {
  const fields = argumentsOf(command, about)
    .filter(({ schema }) => isSimple(schema))
    .map((each) => ({ ...each, field: fieldOf(each) }));
  if (!name.startsWith("stop.")) {
    const rows = fields.map((each) => h("label.row", {}, h("span.grow", {}, each.name), each.field));
    const isSure = await ask({
      title,
      body: [
        h("p", {}, command.summary),
        h("p.hint", {}, [name, command.description].filter(Boolean).join(": ")),
        ...rows,
      ],
      first: fields[0]?.field,
      choices: [
        { text: t("key.cancel"), value: null },
        { text: t(TEXTS.give), value: true, kind: "main", isSubmit: true },
      ],
    });
    if (!isSure) return;
  }
  const given = fields
    .filter(({ field, isNeeded }) => isNeeded || field.value !== "")
    .map(({ name: argument, schema, field }) => [argument, valueOf(schema, field.value)]);
  if ((await give(name, Object.fromEntries(given))) !== null) report(t(TEXTS.given, { name }));
}

/**
 * @param {{ name: string, schema: any, isNeeded: boolean }} argument
 * @returns {HTMLInputElement | HTMLSelectElement}
 */
function fieldOf({ schema, isNeeded }) {
  const choices = schema.enum ?? (schema.type === "boolean" ? [true, false] : null);
  if (choices)
    return h(
      "select.field",
      {},
      ...(isNeeded ? [] : [h("option", { value: "" }, t(TEXTS.unset))]),
      ...choices.map((/** @type {any} */ each) => h("option", { value: JSON.stringify(each) }, String(each))),
    );
  const range = [schema.minimum, schema.maximum ?? schema.exclusiveMaximum].map((each) => each ?? "").join(" \u2026 ");
  const isText = schema.type === "string";
  return h("input.field", {
    placeholder: isText ? "" : range.length > 3 ? range : "",
    inputMode: isText ? "text" : "decimal",
    autocomplete: "off",
    spellcheck: false,
  });
}

/**
 * @param {any} schema
 * @param {string} text
 */
function valueOf(schema, text) {
  if (schema.enum || schema.type === "boolean") return JSON.parse(text);
  if (schema.type === "string") return text;
  const value = Number(text.trim().replace(",", "."));
  return text.trim() && Number.isFinite(value) ? value : text; // the server says what is wrong with a text
}
