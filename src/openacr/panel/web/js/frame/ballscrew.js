// The ballscrew table of an axis: positions from the reference point with their errors, from and to files.
import { ApiError, address, get, latest, send } from "../core/api.js";
import { model, refuse, report } from "../core/app.js";
import { fill, h, setText } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { mayDrop } from "./unsaved.js";

/**
 * @typedef {{ axis: number, name: string, axes: { index: number, name: string }[], unit: string, is_on: boolean,
 *   entries: [number, number][], problem: string }} Kept
 */

/**
 * @param {HTMLElement} host
 * @param {import("../core/signal.js").Endings} endings
 * @returns {() => boolean | Promise<boolean>} whether it may be left
 */
export function showBallscrew(host, endings) {
  /** @type {Kept} */
  let kept;
  let before = "";
  const newest = latest(endings);
  const axes = h("div.row.wrap.grow", { role: "radiogroup", ariaLabel: t("form.axis") });
  const isOn = h("input", { type: "checkbox", onchange: () => edited() });
  const [first, second] = [h("th.number", {}), h("th.number", {})];
  const rows = h("tbody", {});
  const note = h("span.grow.hint", { role: "status" });
  const saveKey = keyOf("form.save", () => save(), ".main");
  const undoKey = keyOf("form.undo", () => load(kept.axis));
  const file = h("input", {
    type: "file",
    hidden: true,
    ariaLabel: t("ballscrew.import"),
    onchange: () => void take(),
  });
  const exported = h("a.key", { role: "button" }, t("ballscrew.export"));
  host.classList.add("form");
  host.append(
    h(
      "div.row.wrap.form-tools",
      {},
      axes,
      h("label.check.row", {}, isOn, t("ballscrew.on")),
      keyOf("ballscrew.import", () => file.click()),
      file,
      exported,
    ),
    h(
      "div.form-rows.scroll.grow",
      { tabIndex: -1 },
      h("p.hint", {}, t("ballscrew.text")),
      h("table.grid.ballscrew", {}, h("thead", {}, h("tr", {}, first, second, h("th", {}))), rows),
      keyOf("ballscrew.add", () => add("", "").focus()),
    ),
    h("div.row.form-foot", {}, note, undoKey, saveKey),
  );

  /** The table as a file; what is typed is checked by the server. */
  const text = () =>
    [...rows.rows]
      .map((row) => [...row.querySelectorAll("input")].map((input) => input.value.trim().replace(",", ".")))
      .filter(([position, error]) => position || error)
      .map(([position, error]) => `${kept.name}${position}E${error}`)
      .join("\n");
  const state = () => `${isOn.checked} ${text()}`;
  const isChanged = () => kept !== undefined && state() !== before;

  function edited() {
    saveKey.disabled = undoKey.disabled = !isChanged() || !model.may("service");
    setText(note, kept.problem || t("ballscrew.count", { count: rows.rows.length }));
  }

  /**
   * @param {string} position
   * @param {string} error
   */
  function add(position, error) {
    const field = (/** @type {string} */ value, /** @type {string} */ label) =>
      h("input.field.number", {
        value,
        ariaLabel: `${label} ${rows.rows.length + 1}`,
        inputMode: "decimal",
        autocomplete: "off",
        oninput: edited,
      });
    const place = field(position, t("ballscrew.position"));
    const row = h(
      "tr",
      {},
      h("td", {}, place),
      h("td", {}, field(error, t("ballscrew.error"))),
      h(
        "td",
        {},
        h(
          "button.key",
          {
            type: "button",
            ariaLabel: t("ballscrew.remove"),
            title: t("ballscrew.remove"),
            onclick: () => {
              row.remove();
              edited();
            },
          },
          "\u2715",
        ),
      ),
    );
    rows.append(row);
    edited();
    return place;
  }

  /** @param {[number, number][]} entries */
  function list(entries) {
    fill(rows);
    for (const [position, error] of entries) add(String(position), String(error));
    edited();
  }

  /** @param {Kept} now */
  function show(now) {
    kept = now;
    fill(
      axes,
      ...now.axes.map((each) =>
        h(
          "button.key",
          {
            type: "button",
            role: "radio",
            ariaChecked: String(each.index === now.axis),
            onclick: async () => {
              if (await mayLeave()) await load(each.index);
            },
          },
          each.name,
        ),
      ),
    );
    isOn.checked = now.is_on;
    setText(first, `${t("ballscrew.position")}, ${now.unit}`);
    setText(second, `${t("ballscrew.error")}, ${now.unit}`);
    exported.toggleAttribute("hidden", now.entries.length === 0);
    exported.href = address("ballscrew/file", { axis: now.axis });
    list(now.entries);
    before = state();
    edited();
  }

  /** @param {number} [axis] */
  async function load(axis) {
    const now = await newest(get("ballscrew", { axis }));
    if (now) show(now);
  }

  /** The entries of a chosen file, not stored yet. */
  async function take() {
    const [chosen] = file.files ?? [];
    file.value = "";
    if (!chosen) return;
    try {
      const own = kept;
      const { entries } = await send("POST", "ballscrew/check", { axis: own.axis, text: await chosen.text() });
      if (kept !== own) return; // another axis is shown by now
      list(entries);
      report(t("ballscrew.imported", { name: chosen.name }));
    } catch (error) {
      refuse(error);
    }
  }

  async function save() {
    const [table, own] = [text(), kept];
    try {
      const now = await send("PUT", "ballscrew", {
        axis: own.axis,
        is_on: isOn.checked,
        ...(table || own.entries.length ? { text: table } : {}),
      });
      if (kept === own) show(now); // no other axis is shown by now
      report(t("ballscrew.saved", { axis: own.name }));
      return true;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      refuse(error);
      return false;
    }
  }

  const mayLeave = () => mayDrop(isChanged() ? 1 : 0, save);
  endings.add(model.hello.watch(() => kept && edited()));
  void load(model.axes[0]?.index).catch(refuse);
  return mayLeave;
}
