// Fields of the scope whose values are kept by the one that shows them.
import { h } from "../core/dom.js";

/**
 * @param {string} label
 * @param {string} value
 * @param {() => void} onchange
 */
export function textField(label, value, onchange) {
  return h("input.field", { ariaLabel: label, title: label, value, autocomplete: "off", spellcheck: false, onchange });
}

/**
 * @param {string} label
 * @param {string} value
 * @param {() => void} onchange
 */
export function numberField(label, value, onchange) {
  const field = textField(label, value, onchange);
  field.classList.add("number");
  field.inputMode = "decimal";
  return field;
}

/**
 * @param {string} label
 * @param {readonly (readonly [string, string])[]} options values with their texts
 * @param {string} value
 * @param {() => void} onchange
 */
export function selectField(label, options, value, onchange) {
  return h(
    "select.field",
    { ariaLabel: label, title: label, onchange },
    ...options.map(([each, text]) => h("option", { value: each, selected: each === value }, text)),
  );
}

/** @param {HTMLInputElement} field */
export function numberOf(field) {
  return Number(field.value.replace(",", "."));
}
