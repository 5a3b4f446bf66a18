// The search of the workspace: one field over all that it has, by keyboard and mouse.
import { latest } from "../core/api.js";
import { refuse } from "../core/app.js";
import { fill, h, setText } from "../core/dom.js";
import { t } from "../core/texts.js";
import { ask } from "../frame/dialog.js";
import { logIn } from "../frame/log_in.js";
import { KINDS, found, readEntries, roleFor, searchValues } from "./palette_entries.js";
import { isPressed, shownKeys } from "./shown_keys.js";

const TEXTS = {
  title: { en: "SEARCH", de: "SUCHEN" },
  field: {
    en: "Pane, command, parameter, flag, line or page of help",
    de: "Fenster, Befehl, Parameter, Flag, Zeile oder Hilfe",
  },
  list: { en: "What is found", de: "Gefundenes" },
  none: { en: "Nothing has this name", de: "Nichts hei\u00dft so" },
  count: { en: "{count} found", de: "{count} gefunden" },
  kinds: {
    en: "> panes and commands   # parameters and flags   : lines of programs   ? help",
    de: "> Fenster und Befehle   # Parameter und Flags   : Programmzeilen   ? Hilfe",
  },
};

/** @typedef {import("./palette_entries.js").Entry} Entry */

/**
 * Open the search; what is chosen is done once it is closed.
 * @param {string} [typed] what is in the field at first
 */
export async function openPalette(typed = "") {
  const newest = latest();
  /** @type {Entry[]} */
  let entries = [];
  /** @type {import("../frame/card_value.js").Item[]} */
  let items = [];
  let current = 0;
  /** @type {{ entry: Entry, act: import("./palette_entries.js").Act } | null} */
  let chosen = null;

  const list = h("ul.palette-list.scroll", { id: "palette-list", role: "listbox", ariaLabel: t(TEXTS.list) });
  const status = h("p.only-heard", { role: "status" });
  const acts = h("p.hint.palette-acts", { ariaHidden: "true" });
  const field = h("input.field", {
    type: "text",
    value: typed,
    role: "combobox",
    ariaLabel: t(TEXTS.field),
    placeholder: t(TEXTS.field),
    autocomplete: "off",
    spellcheck: false,
    ariaExpanded: "true",
    ariaAutoComplete: "list",
    attr: { "aria-controls": "palette-list" },
    oninput: () => search(),
    onkeydown: press,
  });

  function search() {
    items = [];
    current = 0;
    draw();
    newest(searchValues(field.value)).then((answer) => {
      if (!answer) return;
      items = answer;
      draw();
    }, refuse);
  }

  function draw() {
    entries = found(field.value, items);
    current = Math.min(current, Math.max(0, entries.length - 1));
    fill(list, ...entries.map(elementOf));
    setText(status, entries.length ? t(TEXTS.count, { count: entries.length }) : t(TEXTS.none));
    if (!entries.length)
      fill(list, h("li.quiet", { role: "option", ariaSelected: "false", ariaDisabled: "true" }, t(TEXTS.none)));
    mark();
  }

  /** Show which entry the keys act on. */
  function mark() {
    [...list.children].forEach((each, n) => each.setAttribute("aria-selected", String(n === current)));
    const now = entries.length ? list.children[current] : null;
    field.setAttribute("aria-activedescendant", now?.id ?? "");
    now?.scrollIntoView({ block: "nearest" });
    const [, ...others] = entries[current]?.acts ?? [];
    const texts = [entries[current]?.acts[0], ...others].flatMap((each) => each ?? []);
    setText(acts, texts.map((each) => `${shownKeys(each.keys)}: ${t(each.label)}`).join("   ") || t(TEXTS.kinds));
  }

  /**
   * @param {Entry} entry
   * @param {number} n
   */
  function elementOf(entry, n) {
    const role = roleFor(entry);
    return h(
      "li.palette-entry",
      {
        id: `palette-${n}`,
        role: "option",
        data: { kind: entry.kind },
        onclick: () => choose(n, 0),
        onpointermove: () => {
          if (current === n) return;
          current = n;
          mark();
        },
      },
      h("span.palette-title", { title: entry.title }, entry.title),
      h("span.quiet.palette-detail", {}, entry.detail),
      role ? h("span.palette-role", {}, t("role.needed", { role: t(/** @type {any} */ (`role.${role}`)) })) : "",
      ...entry.acts.slice(1).map((act, place) =>
        h(
          "span.key.palette-act", // of the mouse: the keyboard has the keys
          {
            title: shownKeys(act.keys),
            onclick: (/** @type {Event} */ event) => {
              event.stopPropagation();
              choose(n, place + 1);
            },
          },
          t(act.label),
        ),
      ),
      entry.keys ? h("kbd", {}, shownKeys(entry.keys)) : "",
      h("span.palette-kind", {}, t(KINDS[entry.kind].name)),
    );
  }

  /**
   * @param {number} n of the entry
   * @param {number} act
   */
  function choose(n, act) {
    if (!entries[n]) return;
    chosen = { entry: entries[n], act: entries[n].acts[act] };
    field.form?.requestSubmit();
  }

  /** @param {KeyboardEvent} event */
  function press(event) {
    const step = { ArrowDown: 1, ArrowUp: -1, PageDown: 8, PageUp: -8 }[event.key];
    if (step !== undefined) {
      const last = entries.length - 1;
      const to = current + step;
      current = Math.abs(step) > 1 ? Math.max(0, Math.min(last, to)) : to < 0 ? last : to > last ? 0 : to;
      mark();
    } else if (event.key === "Enter") {
      const act = entries[current]?.acts.findIndex((each) => isPressed(event, each.keys)) ?? -1;
      if (act >= 0) choose(current, act);
    } else return;
    event.preventDefault();
  }

  draw();
  readEntries(draw).catch(refuse);
  if (typed) search();
  await ask({
    title: t(TEXTS.title),
    className: "wide palette",
    first: field,
    body: [field, status, list, acts],
    choices: [{ text: t("key.close"), value: () => chosen, isSubmit: true }],
  });
  newest(Promise.resolve(null));
  if (!chosen) return;
  const { entry, act } = /** @type {{ entry: Entry, act: import("./palette_entries.js").Act }} */ (chosen);
  const role = roleFor(entry);
  if (role && !(await logIn(role))) return;
  await act.does();
}
