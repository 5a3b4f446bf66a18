// The number pad: digits for fingers, sums for everyone ("25.4*3/8").
import { evaluate, tidy } from "../core/arithmetic.js";
import { h, setText } from "../core/dom.js";
import { t } from "../core/texts.js";
import { ask } from "./dialog.js";

const ROWS = [
  ["7", "8", "9", "/", "back"],
  ["4", "5", "6", "*", "clear"],
  ["1", "2", "3", "-", "("],
  ["0", ".", "sign", "+", ")"],
];
/** @type {Record<string, string>} */
const FACES = { "*": "\u00d7", "/": "\u00f7", "-": "\u2212", back: "\u232b", clear: "C", sign: "\u00b1" };

// A number field that is entered by mouse or finger is selected, as it is by Tab: the first digit replaces the value.
/** @type {Element | null} */
let before = null; // where the focus was when the pointer went down
window.addEventListener(
  "pointerdown",
  () => {
    before = document.activeElement;
  },
  { capture: true },
);
window.addEventListener("click", ({ target }) => {
  if (!(target instanceof HTMLInputElement) || target === before || !target.matches(".number, .pad-value")) return;
  if (target.selectionStart === target.selectionEnd) target.select(); // what was marked with the mouse stays marked
});

/**
 * Ask for a number; null when cancelled.
 *
 * `check` returns why a value is not allowed, or "" if it is.
 * @param {{ title: string, value?: number | null, unit?: string, hint?: string,
 *   check?: (value: number) => string }} options
 * @returns {Promise<number | null>}
 */
export function askNumber({ title, value = null, unit = "", hint = "", check = () => "" }) {
  const field = h("input.field.pad-value", {
    value: value === null ? "" : tidy(value),
    inputMode: "none",
    autocomplete: "off",
    spellcheck: false,
    ariaLabel: unit ? `${title} (${unit})` : title,
  });
  const note = h("div.hint", { attr: { "aria-live": "polite" } }, hint);
  const show = () => {
    const sum = evaluate(field.value);
    note.className = "hint";
    setText(note, /[-+*/(]/.test(field.value.slice(1)) && sum !== null ? `= ${tidy(sum)} ${unit}` : hint);
  };
  field.addEventListener("input", show);
  const press = (/** @type {string} */ name) => {
    apply(field, name);
    show();
  };
  const pad = h(
    "div.pad",
    {},
    ...ROWS.flat().map((name) =>
      h(
        "button.key",
        {
          type: "button",
          ariaLabel: name === "back" || name === "clear" || name === "sign" ? t(`pad.${name}`) : name,
          onmousedown: (/** @type {Event} */ event) => event.preventDefault(), // the field keeps the focus: Enter is OK
          onclick: () => press(name),
        },
        FACES[name] ?? name,
      ),
    ),
  );
  const accept = () => {
    const sum = evaluate(field.value);
    const refusal = sum === null ? t("pad.none") : check(sum);
    if (!refusal) return sum;
    note.className = "refusal";
    setText(note, refusal);
    return undefined;
  };
  const body = [h("div.row", {}, field, unit ? h("span.quiet", {}, unit) : ""), note, pad];
  return ask({
    title,
    body,
    first: field,
    choices: [
      { text: t("key.cancel"), value: null },
      { text: t("key.ok"), kind: "main", isSubmit: true, value: accept },
    ],
  });
}

/**
 * What a key of the pad does to the field; the first digit replaces a selected value.
 * @param {HTMLInputElement} field
 * @param {string} name
 */
function apply(field, name) {
  if (name === "clear") field.value = "";
  else if (name === "sign") field.value = field.value.startsWith("-") ? field.value.slice(1) : `-${field.value}`;
  else {
    const [start, end] = [field.selectionStart ?? field.value.length, field.selectionEnd ?? field.value.length];
    if (name === "back") field.setRangeText("", start === end ? Math.max(0, start - 1) : start, end, "end");
    else field.setRangeText(name, start, end, "end");
  }
}
