// Any form of the server: rows with units, limits and help; SAVE keeps refused values in their fields.
import { ApiError, get, latest, send } from "../core/api.js";
import { model, refuse, report } from "../core/app.js";
import { fill, h, setText } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { loadSettingTexts, settingText } from "../core/settings_texts.js";
import { t } from "../core/texts.js";
import { fieldFor } from "./field.js";
import { logIn } from "./log_in.js";
import { askNumber } from "./number_pad.js";
import { mayDrop } from "./unsaved.js";

const PAGE = 20;

/**
 * @typedef {import("./field.js").FormRow} FormRow
 * @typedef {object} Form
 * @property {string} name
 * @property {string} title
 * @property {string} role
 * @property {string} section
 * @property {boolean} per_axis
 * @property {number} axis
 * @property {{ index: number, name: string }[]} axes
 * @property {string} locked
 * @property {{ title: string, rows: FormRow[] }[]} groups
 * @property {{ first: number, count: number, total: number } | null} page
 */

/**
 * Show a form; returns what asks whether it may be left.
 * @param {HTMLElement} host
 * @param {string} name
 * @param {import("../core/signal.js").Endings} endings
 * @param {(title: string) => void} [setTitle]
 */
export function showForm(host, name, endings, setTitle = () => {}) {
  /** @type {Map<string, import("./field.js").Field>} */
  let fields = new Map();
  /** @type {Form | null} */
  let form = null;
  let axis = 0;
  let first = 1;
  const newest = latest(endings);
  const tools = h("div.row.wrap.form-tools", {});
  const rows = h("div.form-rows.scroll.grow", { tabIndex: -1 });
  const note = h("span.grow.hint", { attr: { "aria-live": "polite" } });
  const saveKey = keyOf("form.save", () => save(), ".main", { disabled: true });
  const undoKey = keyOf("form.undo", () => load(), "", { disabled: true });
  host.classList.add("form");
  host.append(tools, rows, h("div.row.form-foot", {}, note, undoKey, saveKey));

  const changed = () => [...fields].filter(([, field]) => field.isChanged());
  function changedNow() {
    const count = changed().length;
    saveKey.disabled = undoKey.disabled = count === 0;
    setText(
      note,
      count ? t("form.changed", { count }) : form?.locked ? t("form.locked", { reason: settingText(form.locked) }) : "",
    );
  }

  /** @returns {Promise<Form>} */
  async function stored() {
    const shown = { axis: form?.per_axis === false ? undefined : axis, first, count: PAGE };
    const [found] = await Promise.all([get(`forms/${name}`, shown), loadSettingTexts()]);
    return found;
  }

  /** Draw what is stored. What was typed is dropped. */
  async function load() {
    const now = await newest(stored());
    if (!now) return;
    form = now;
    if (form.per_axis && form.axis !== undefined) axis = form.axis;
    draw(form);
  }

  /**
   * Draw what is stored. What was typed until the answers came stays, with its refusals and the focus.
   * @param {Record<string, string>} [sent] texts that are stored by now
   */
  async function renew(sent = {}) {
    const shown = fields;
    const now = await stored();
    if (fields !== shown) return; // another axis or page is shown by now
    const typed = changed()
      .filter(([number, field]) => field.text() !== sent[number])
      .map(([number, field]) => ({ number, text: field.text(), refusal: field.refusal() }));
    const focused = rows.contains(document.activeElement) ? document.activeElement?.id : "";
    form = now;
    draw(now);
    for (const { number, text, refusal } of typed) {
      fields.get(number)?.type(text);
      fields.get(number)?.refuse(refusal);
    }
    if (focused) document.getElementById(focused)?.focus();
  }

  /** The first row has the focus of a form that was just opened: its value is typed at once. */
  function begin() {
    const top = rows.querySelector("input:enabled:not([readonly]), select:enabled");
    const isElsewhere = document.activeElement?.closest("dialog, [role=tablist], .form-tabs");
    if (!(top instanceof HTMLElement) || isElsewhere) return;
    top.focus();
    if (top instanceof HTMLInputElement) top.select();
  }

  /** @param {Form} shown */
  function draw(shown) {
    setTitle(settingText(shown.title));
    setText(saveKey, t(shown.section === "OFFSETS" ? "form.savepage" : "form.save"));
    fields = new Map();
    const isBarred = !model.may(shown.role);
    fill(tools, ...axisKeys(shown), ...pageKeys(shown));
    tools.hidden = !tools.childElementCount;
    fill(
      rows,
      ...(isBarred
        ? [
            h(
              "div.notice.row",
              {},
              h("span.grow", {}, t("role.needed", { role: t(/** @type {any} */ (`role.${shown.role}`)) })),
              keyOf("login.go", async () => (await logIn(shown.role)) && load()),
            ),
          ]
        : []),
      ...shown.groups.map((group) =>
        h(
          "fieldset.form-group",
          { disabled: isBarred },
          group.title ? h("legend", {}, settingText(group.title)) : "",
          ...group.rows.map((row) => {
            const field = fieldFor(row, changedNow, shown.per_axis);
            fields.set(String(row.number), field);
            return field.element;
          }),
        ),
      ),
    );
    changedNow();
  }

  /** @param {Form} shown */
  function axisKeys(shown) {
    if (!shown.per_axis) return [];
    return [
      h(
        "div.row.wrap",
        { role: "radiogroup", ariaLabel: t("form.axis") },
        ...shown.axes.map((each) =>
          h(
            "button.key",
            {
              type: "button",
              role: "radio",
              ariaChecked: String(each.index === shown.axis),
              onclick: async () => {
                if (!(await mayLeave())) return;
                axis = each.index;
                await load();
              },
            },
            each.name,
          ),
        ),
      ),
    ];
  }

  /** @param {Form} shown */
  function pageKeys(shown) {
    const page = shown.page;
    if (!page || page.total <= page.count) return [];
    const go = async (/** @type {number} */ place) => {
      if (!(await mayLeave())) return;
      first = Math.min(Math.max(1, place), Math.max(1, page.total - page.count + 1));
      await load();
    };
    const find = async () => {
      const wanted = await askNumber({
        title: t("form.goto"),
        value: page.first,
        hint: t("form.goto.hint", { last: page.total }),
      });
      if (wanted !== null) await go(Math.floor((wanted - 1) / PAGE) * PAGE + 1);
    };
    return [
      h(
        "button.key",
        { type: "button", disabled: page.first <= 1, onclick: () => go(page.first - PAGE) },
        "\u25c0 ",
        t("form.previous"),
      ),
      h(
        "button.key",
        { type: "button", onclick: find },
        t("form.page", {
          first: page.first,
          last: Math.min(page.total, page.first + page.count - 1),
          total: page.total,
        }),
      ),
      h(
        "button.key",
        { type: "button", disabled: page.first + page.count > page.total, onclick: () => go(page.first + PAGE) },
        t("form.next"),
        " \u25b6",
      ),
    ];
  }

  /** Store what has changed; a refused value stays in its field with the reason. */
  async function save() {
    const values = Object.fromEntries(changed().map(([number, field]) => [number, field.text()]));
    if (!Object.keys(values).length) return true;
    for (const field of fields.values()) field.refuse("");
    try {
      await send("PUT", `forms/${name}`, { values });
      report(t("form.saved", { count: Object.keys(values).length }));
      await renew(values);
      return true;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      const refused = error.body?.refused ?? {};
      for (const [number, reason] of Object.entries(refused)) fields.get(number)?.refuse(String(reason));
      const [worst] = Object.keys(refused);
      if (worst) fields.get(worst)?.focus();
      refuse(worst ? t("form.refused", { count: Object.keys(refused).length }) : error.message);
      return false;
    }
  }

  const mayLeave = () => mayDrop(changed().length, save);

  endings.add(
    model.changed.watch((what) => {
      if (what.what !== "forms" || !form || !what.cells?.some((cell) => fields.has(String(cell)))) return;
      if (changed().length) setText(note, t("form.elsewhere"));
      else void renew();
    }),
  );
  host.addEventListener("keydown", (event) => {
    const isField = event.target instanceof HTMLInputElement && event.target.type !== "checkbox";
    if (event.key === "Enter" && isField) void save();
  });
  void load().then(begin).catch(refuse);
  return mayLeave;
}
