// RUN and DRY RUN: the start line, what a start in the middle would change, and the confirmation.
import { get } from "../core/api.js";
import { give, model, refuse } from "../core/app.js";
import { numberIn } from "../core/arithmetic.js";
import { h } from "../core/dom.js";
import { duration } from "../core/format.js";
import { t } from "../core/texts.js";
import { ask } from "../frame/dialog.js";

/**
 * Ask for the start line, then start; a start line after 1 is rehearsed and shown first.
 * @param {{ dry: boolean, line?: number }} options
 */
export async function beginRun({ dry, line = 1 }) {
  const loaded = model.program.value.loaded;
  if (!loaded) {
    refuse(t("run.none"));
    return;
  }
  const bar = model.state.value.can?.["run.begin"];
  if (bar) {
    refuse(bar);
    return;
  }
  const wrong = loaded.errors ? await errorsOf() : []; // found by reading it, with the machine as it was then
  const field = h("input.field.number", {
    value: String(line),
    inputMode: "numeric",
    ariaLabel: t("run.line"),
    autocomplete: "off",
  });
  const [skip, optional] = [
    checkBox(t("run.skip"), model.is("skip")),
    checkBox(t("run.optional"), model.is("optional")),
  ];
  const safe = h("input.field.number", { inputMode: "decimal", ariaLabel: t("run.safez"), autocomplete: "off" });
  const safeRow = h("label.row", { title: t("run.safez.hint") }, h("span.grow", {}, t("run.safez")), safe);
  const offer = () => {
    safeRow.hidden = Number(field.value) === 1;
  };
  field.addEventListener("input", offer);
  offer();
  const note = h("div.refusal", { hidden: true });
  const first = () => {
    const number = Number(field.value);
    const isLine = Number.isInteger(number) && number >= 1 && number <= Math.max(1, loaded.lines);
    note.hidden = isLine;
    note.textContent = t("run.range", { last: loaded.lines });
    if (!isLine) return undefined;
    try {
      return { line: number, safe_z: number === 1 ? undefined : (numberIn(safe, t("run.safez")) ?? undefined) };
    } catch (error) {
      note.hidden = false;
      note.textContent = error instanceof Error ? error.message : String(error);
      return undefined;
    }
  };
  const rows = [
    h(
      "div.row.wrap",
      {},
      h("strong.mono", {}, loaded.name),
      h("span.quiet", {}, t("run.lines", { count: loaded.lines })),
      loaded.seconds === null ? "" : h("span.quiet", {}, t("run.seconds", { time: duration(loaded.seconds) })),
    ),
    dry ? h("div.notice", {}, t("run.dry")) : "",
    ...wrong,
    h("label.row", {}, h("span.grow", {}, t("run.line")), field),
    note,
    safeRow,
    h("div.row.wrap", {}, skip, optional),
  ];
  const chosen = await ask({
    title: dry ? t("menu.dryrun") : t("menu.runline"),
    body: rows,
    first: field,
    choices: [
      { text: t("key.cancel"), value: null },
      wrong.length
        ? { text: t("run.anyway"), kind: "bad", value: first }
        : { text: t("run.begin"), kind: "main", isSubmit: true, value: first },
    ],
  });
  if (chosen === null) return;
  const args = {
    ...chosen,
    dry,
    skip: skip.querySelector("input")?.checked,
    optional: optional.querySelector("input")?.checked,
  };
  const answer = await give("run.begin", args);
  if (answer?.rehearsal && (await accepts(chosen.line, answer.rehearsal)))
    await give("run.begin", { ...args, confirm: answer.rehearsal.token });
}

/** The errors of the loaded program, as parts of a dialog. */
async function errorsOf() {
  const [{ findingList }, found] = await Promise.all([import("../frame/findings.js"), get("program")]);
  return [h("div.notice.bad", {}, t("run.wrong")), findingList(found, true)];
}

/**
 * Show what differs from the state the program would have at its start line.
 * @param {number} line
 * @param {any} rehearsal
 */
function accepts(line, rehearsal) {
  const rows = (rehearsal.differences ?? []).map((/** @type {any} */ each) =>
    h("tr", {}, h("td", {}, each.name), h("td.number", {}, each.present), h("td.number", {}, each.wanted)),
  );
  return ask({
    comes: true,
    title: t("begin.title", { line }),
    body: [
      h("p", {}, rehearsal.text || t("begin.text")),
      ...(rehearsal.warnings ?? []).map((/** @type {string} */ text) => h("div.notice", {}, text)),
      rehearsal.needs_tool ? h("div.notice.bad", {}, t("begin.tool")) : "",
      rows.length
        ? h(
            "table.grid",
            {},
            h(
              "thead",
              {},
              h(
                "tr",
                {},
                h("th", {}, ""),
                h("th.number", {}, t("begin.present")),
                h("th.number", {}, t("begin.wanted")),
              ),
            ),
            h("tbody", {}, ...rows),
          )
        : "",
    ],
    choices: [
      { text: t("key.cancel"), value: null },
      { text: t("begin.go"), kind: "danger", value: true },
    ],
  });
}

/**
 * @param {string} text
 * @param {boolean} isOn
 */
function checkBox(text, isOn) {
  return h("label.check", {}, h("input", { type: "checkbox", checked: isOn }), text);
}
