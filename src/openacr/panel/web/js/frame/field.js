// One row of a form: its field by its kind, with unit, limits, default, help and refusal.
import { h, setText } from "../core/dom.js";
import { refusalText, settingText } from "../core/settings_texts.js";
import { t } from "../core/texts.js";
import { PENS } from "../draw/colors.js";
import { askNumber } from "./number_pad.js";

/**
 * @typedef {object} FormRow
 * @property {number | string} number
 * @property {string} name
 * @property {string} [axis_name]
 * @property {"real" | "integer" | "boolean" | "choice" | "text"} kind
 * @property {string} unit
 * @property {string} value
 * @property {number} number_value
 * @property {string} default
 * @property {number | null} low
 * @property {number | null} high
 * @property {Record<string, string> | null} words
 * @property {string[]} [bits] what the bits of a whole number mean, from bit 0 on
 * @property {string} typical
 * @property {string} help
 * @property {boolean} motion
 * @property {boolean} fixed
 * @property {boolean} is_default
 *
 * @typedef {object} Field
 * @property {HTMLElement} element
 * @property {() => boolean} isChanged
 * @property {() => string} text
 * @property {(text: string) => void} type as the operator would
 * @property {(reason: string) => void} refuse
 * @property {() => string} refusal the reason of the last one, empty without
 * @property {() => void} focus
 */

/**
 * @param {FormRow} row
 * @param {() => void} changed
 * @param {boolean} [isPerAxis] whether the form shows one axis, so that rows need not name it
 * @returns {Field}
 */
export function fieldFor(row, changed, isPerAxis = false) {
  const id = `cell-${row.number}`;
  const input = inputFor(row, id);
  const read = () =>
    input instanceof HTMLInputElement && input.type === "checkbox" ? (input.checked ? "1" : "0") : input.value;
  const before = read();
  const refusal = h("span.refusal", { id: `${id}-refusal`, attr: { "aria-live": "polite" } });
  const isChanged = () => read() !== before;
  const edited = () => {
    input.classList.toggle("is-changed", isChanged());
    refuse("");
    changed();
  };
  /** @param {string} reason */
  function refuse(reason) {
    setText(refusal, refusalText(reason));
    refusal.hidden = !reason;
    if (reason) input.setAttribute("aria-invalid", "true");
    else input.removeAttribute("aria-invalid");
  }
  input.addEventListener("input", edited);
  input.setAttribute("aria-describedby", `${id}-hint ${id}-refusal`);
  refuse("");
  const hint = h("span.hint", { id: `${id}-hint` }, hintOf(row));
  const pad =
    (row.kind === "real" || row.kind === "integer") && !row.fixed
      ? h(
          "button.key.pad-key",
          {
            type: "button",
            title: t("pad.open"),
            ariaLabel: t("pad.open"),
            onclick: async () => {
              const value = await askNumber({
                title: settingText(row.name),
                value: Number(input.value.replace(",", ".")) || 0,
                unit: row.unit,
                hint: limitsOf(row),
              });
              if (value === null) return;
              input.value = String(value);
              edited();
            },
          },
          "\u2328",
        )
      : "";
  return {
    element: h(
      "div.form-row",
      {},
      h(
        "label",
        { htmlFor: id, title: row.name },
        row.axis_name && !isPerAxis ? `${row.axis_name}  ${settingText(row.name)}` : settingText(row.name),
      ),
      h("div.row.form-input", {}, input, row.unit ? h("span.unit", {}, row.unit) : "", pad),
      hint,
      isColour(row) ? swatches(row, input) : "",
      row.bits?.length ? bitBoxes(row, input) : "",
      refusal,
    ),
    isChanged,
    text: read,
    refuse,
    refusal: () => refusal.textContent ?? "",
    focus: () => input.focus(),
    type(text) {
      if (input instanceof HTMLInputElement && input.type === "checkbox") input.checked = text === "1";
      else input.value = text;
      edited();
    },
  };
}

/** Whether a whole number is one of the colours of paths. @param {FormRow} row */
function isColour(row) {
  return row.kind === "integer" && Object.keys(row.words ?? {}).length === PENS.length;
}

/**
 * The colours of paths with their names: a press chooses one.
 * @param {FormRow} row
 * @param {HTMLInputElement | HTMLSelectElement} input
 */
function swatches(row, input) {
  const keys = PENS.map((pen, n) => {
    const name = `${n}: ${settingText(row.words?.[n] ?? "")}`;
    const key = h("button.swatch", {
      type: "button",
      title: name,
      ariaLabel: `${settingText(row.name)} ${name}`,
      disabled: row.fixed,
      onclick: () => {
        input.value = String(n);
        input.dispatchEvent(new Event("input"));
      },
    });
    key.style.background = pen;
    return key;
  });
  const name = h("span.hint", {});
  const draw = () => {
    const chosen = Number(input.value.trim() || NaN);
    setText(name, settingText(row.words?.[chosen] ?? ""));
    keys.forEach((key, n) => {
      key.ariaPressed = String(n === chosen);
    });
  };
  input.addEventListener("input", draw);
  draw();
  return h("div.row.wrap.swatches", {}, ...keys, name);
}

/**
 * The bits of a whole number with what they mean: a box sets one.
 * @param {FormRow} row
 * @param {HTMLInputElement | HTMLSelectElement} input
 */
function bitBoxes(row, input) {
  const bits = row.bits ?? [];
  const boxes = bits.map(() =>
    h("input", {
      type: "checkbox",
      disabled: row.fixed,
      onchange: () => {
        input.value = String(boxes.reduce((sum, box, bit) => sum + (box.checked ? 1 << bit : 0), 0));
        input.dispatchEvent(new Event("input"));
      },
    }),
  );
  const draw = () =>
    boxes.forEach((box, n) => {
      box.checked = ((Number(input.value) >> n) & 1) === 1;
    });
  input.addEventListener("input", draw);
  draw();
  return h("div.bits", {}, ...bits.map((text, n) => h("label.row", {}, boxes[n], `${n}: ${settingText(text)}`)));
}

/**
 * @param {FormRow} row
 * @param {string} id
 * @returns {HTMLInputElement | HTMLSelectElement}
 */
function inputFor(row, id) {
  if (row.kind === "boolean")
    return h("input", { id, type: "checkbox", checked: Number(row.number_value) !== 0, disabled: row.fixed });
  if (row.words && row.kind === "choice") {
    const chosen = String(row.number_value);
    const options = Object.entries(row.words).map(([value, text]) =>
      h("option", { value, selected: value === chosen }, settingText(text)),
    );
    if (!(chosen in row.words)) options.unshift(h("option", { value: row.value, selected: true }, row.value));
    return h("select.field", { id, disabled: row.fixed }, ...options);
  }
  const isNumber = row.kind === "real" || row.kind === "integer";
  return h("input.field", {
    id,
    value: row.value,
    readOnly: row.fixed,
    autocomplete: "off",
    spellcheck: false,
    className: isNumber ? "field number" : "field",
    inputMode: isNumber ? "decimal" : "text",
  });
}

/** @param {FormRow} row */
function limitsOf(row) {
  if (row.kind !== "real" && row.kind !== "integer") return "";
  const [low, high] = [row.low, row.high];
  if (low === null && high === null) return "";
  if (high === null) return t("field.least", { low: String(low) });
  return low === null ? t("field.most", { high }) : t("field.range", { low, high });
}

/** @param {FormRow} row */
function hintOf(row) {
  const facts = [
    limitsOf(row),
    ...(row.kind === "integer" && !isColour(row)
      ? Object.entries(row.words ?? {}).map(([value, word]) => `${value}: ${settingText(word)}`)
      : []),
    row.typical ? t("field.typical", { value: settingText(row.typical) }) : "",
    row.default !== "" && !row.is_default
      ? t("field.default", { value: settingText(row.words?.[row.default] ?? row.default) })
      : "",
    row.motion ? t("field.motion") : "",
  ]
    .filter(Boolean)
    .join(" \u00b7 ");
  return [settingText(row.help), facts].filter(Boolean).join(" \u2014 ");
}
