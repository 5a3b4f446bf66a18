// The rows of one dialog of the wizard.
import { h } from "../../core/dom.js";
import { settingText } from "../../core/settings_texts.js";
import { t } from "../../core/texts.js";
import { textOf, valueOf } from "./answers.js";

/**
 * @param {import("./answers.js").Dialog} dialog
 * @param {Record<string, any>} table what is answered
 * @param {Record<string, string>} refusals by key
 * @param {(key: string, value: any) => void} answer
 */
export function formOf(dialog, table, refusals, answer) {
  return h(
    "div.wizard-form",
    { role: "group", ariaLabel: settingText(dialog.title) },
    ...dialog.rows.map((row) => rowOf(row, table[row.key], refusals[row.key], answer)),
  );
}

/**
 * @param {import("./answers.js").Row} row
 * @param {any} value
 * @param {string | undefined} refusal
 * @param {(key: string, value: any) => void} answer
 */
function rowOf(row, value, refusal, answer) {
  const id = `wizard-${row.key}`;
  const input = inputOf(row, textOf(row, value));
  Object.assign(input, { id, ariaInvalid: refusal ? "true" : null });
  input.setAttribute("aria-describedby", `${id}-help`);
  input.addEventListener("change", () => answer(row.key, valueOf(row, textIn(input))));
  return h(
    "div.form-row",
    {},
    h("label", { htmlFor: id, title: row.title }, settingText(row.title)),
    h("div.row.form-input", {}, input, h("span.unit", {}, row.unit)),
    h("span.hint", { id: `${id}-help` }, settingText(row.help)),
    refusal ? h("span.refusal", { role: "alert" }, refusal) : "",
  );
}

/**
 * @param {import("./answers.js").Row} row
 * @param {string} text
 * @returns {HTMLInputElement | HTMLSelectElement}
 */
function inputOf(row, text) {
  if (row.kind === "choice")
    return h(
      "select.field",
      {},
      ...(row.choices ?? []).map((each) => h("option", { value: each, selected: each === text }, each)),
    );
  if (row.kind === "switch" && row.is_optional) {
    const states = [
      ["", t("wizard.unset")],
      ["1", t("wizard.on")],
      ["0", t("wizard.off")],
    ];
    return h(
      "select.field",
      {},
      ...states.map(([state, word]) => h("option", { value: state, selected: state === text }, word)),
    );
  }
  if (row.kind === "switch") return h("input", { type: "checkbox", checked: text === "1" });
  const isNumber = row.kind === "number" || row.kind === "count";
  return h(isNumber ? "input.field.number" : "input.field", {
    value: text,
    inputMode: isNumber ? "decimal" : "text",
    autocomplete: "off",
    spellcheck: false,
  });
}

/** @param {HTMLInputElement | HTMLSelectElement} input */
function textIn(input) {
  if (input instanceof HTMLInputElement && input.type === "checkbox") return input.checked ? "1" : "0";
  return input.value;
}
