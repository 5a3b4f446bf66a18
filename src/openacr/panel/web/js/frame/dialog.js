// Dialogs: Escape cancels, Enter chooses the main key. Everything but STOP is inert meanwhile; a
// dialog shown by showModal() would make STOP inert as well.
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";

/**
 * @typedef {{ text: string, value: any, kind?: "main" | "danger" | "bad", isSubmit?: boolean }} Choice
 */

const APART = ["header.top", "#work", "#prompt", "#menu"];
/** @type {HTMLDialogElement[]} */
const open = [];
let lastId = 0;

// Wherever the focus is (on STOP, too), Escape cancels the last opened dialog.
window.addEventListener(
  "keydown",
  (event) => {
    const last = open.at(-1);
    if (event.key !== "Escape" || !last) return;
    event.preventDefault();
    event.stopPropagation();
    last.dispatchEvent(new Event("cancel"));
  },
  { capture: true },
);

// A key that is held down chooses once: not what a dialog asks that comes meanwhile.
window.addEventListener(
  "keydown",
  (event) => {
    const isKey = event.target instanceof HTMLButtonElement || event.key === "Enter";
    if (open.length && event.repeat && isKey && (event.key === "Enter" || event.key === " ")) event.preventDefault();
  },
  { capture: true },
);

/** Only the last opened dialog takes input. */
function part() {
  for (const place of APART) document.querySelector(place)?.toggleAttribute("inert", open.length > 0);
  open.forEach((dialog, n) => dialog.toggleAttribute("inert", n < open.length - 1));
  document.body.classList.toggle("has-dialog", open.length > 0);
}

/**
 * Show a dialog; resolves with the value of the chosen key, null when it is cancelled.
 *
 * A choice whose value is a function is called; it keeps the dialog open by returning undefined.
 * A dialog that `comes` by itself begins at its first choice: an Enter meant for what was there before
 * does no harm.
 * @param {{ title: string, body: (Node | string)[], choices: Choice[], first?: HTMLElement, className?: string,
 *   comes?: boolean }} options
 * @returns {Promise<any>}
 */
export function ask({ title, body, choices, first, className = "", comes = false }) {
  return new Promise((resolve) => {
    const id = `dialog-${++lastId}`;
    const before = document.activeElement;
    const close = (/** @type {any} */ value) => {
      open.splice(open.indexOf(dialog), 1);
      dialog.remove();
      part();
      if (before instanceof HTMLElement && before.isConnected) before.focus();
      resolve(value);
    };
    const choose = async (/** @type {Choice} */ choice) => {
      const value = typeof choice.value === "function" ? await choice.value() : choice.value;
      if (value !== undefined) close(value);
    };
    const keys = choices.map((choice) =>
      h(
        "button",
        {
          type: choice.isSubmit ? "submit" : "button",
          className: `key ${choice.kind ?? ""}`,
          onclick: choice.isSubmit ? undefined : () => choose(choice),
        },
        choice.text,
      ),
    );
    const submit = choices.find((choice) => choice.isSubmit);
    const form = h(
      "form.dialog-form",
      {
        onsubmit: (/** @type {Event} */ event) => {
          event.preventDefault();
          if (submit) void choose(submit);
        },
      },
      h("div.dialog-body", {}, ...body),
      h("div.dialog-foot", {}, ...keys),
    );
    const dialog = h(
      "dialog",
      { className: `dialog ${className}`, attr: { "aria-labelledby": id }, oncancel: () => close(null) },
      h("div.dialog-head", {}, h("h2", { id }, title)),
      form,
    );
    document.body.append(dialog);
    dialog.show();
    open.push(dialog);
    part();
    const safest = keys[comes || choices.at(-1)?.kind === "bad" ? 0 : keys.length - 1]; // Enter ends nothing unread
    (first ?? safest)?.focus();
    if (first instanceof HTMLInputElement) first.select(); // the first digit replaces the value
  });
}

/**
 * Ask whether something is to be done; true for yes.
 * @param {string} title
 * @param {string} text
 * @param {string} yes
 * @param {"main" | "danger" | "bad"} [kind]
 */
export async function confirm(title, text, yes, kind = "danger") {
  const choices = [
    { text: t("key.cancel"), value: null },
    { text: yes, value: true, kind, isSubmit: true },
  ];
  return Boolean(await ask({ title, body: [h("p", {}, text)], choices: /** @type {Choice[]} */ (choices) }));
}

/**
 * Ask for one line of text; null when cancelled.
 * @param {string} title
 * @param {string} label
 * @param {string} [value]
 */
export function askText(title, label, value = "") {
  const field = h("input.field", { value, ariaLabel: label, autocomplete: "off", spellcheck: false });
  return ask({
    title,
    body: [h("label.stack", {}, label, field)],
    first: field,
    choices: [
      { text: t("key.cancel"), value: null },
      { text: t("key.ok"), kind: "main", isSubmit: true, value: () => field.value.trim() || undefined },
    ],
  });
}
