// What is wrong with a program: errors and warnings with line and column, each a way into EDIT.
import { get } from "../core/api.js";
import { model, prompt, refuse } from "../core/app.js";
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { ask } from "./dialog.js";
import { openScreen } from "./screen_host.js";

/**
 * @typedef {{ line: number, column: number, severity: "error" | "warning", code: string, text: string, hint: string,
 *   file: string }} Finding
 * @typedef {import("../core/model.js").Loaded & { findings: Finding[] }} Found
 *
 * @param {Finding[]} list
 * @param {(finding: Finding) => void} chosen
 */
export function findingItems(list, chosen) {
  return list.map((each) =>
    h(
      "button.key.item",
      { type: "button", className: `key item ${each.severity}`, title: each.hint, onclick: () => chosen(each) },
      h("span", {}, each.severity === "error" ? "\u26a0" : "\u2139"),
      h("span.number", {}, `${each.line}:${each.column}`),
      h("span.name", {}, `${each.code} ${each.text}`),
    ),
  );
}

/**
 * The findings of the loaded program as a list; a press leads to their line in EDIT.
 * @param {Found} found
 * @param {boolean} [isErrors] without the warnings
 */
export function findingList(found, isErrors = false) {
  const list = found.findings.filter((each) => !isErrors || each.severity === "error");
  const box = h(
    "div.findings.scroll",
    {},
    ...findingItems(list, (finding) => {
      if (found.kind !== "file" || finding.file !== found.name) return; // the text of a part, or an included one
      box.closest("dialog")?.dispatchEvent(new Event("cancel"));
      void openScreen("edit", { path: found.path, line: finding.line, column: finding.column });
    }),
  );
  return box;
}

/** Show what is wrong with the loaded program. */
export async function showFindings() {
  /** @type {Found | null} */
  const found = await get("program").catch(refuse);
  if (found)
    await ask({
      title: summary(found),
      body: [findingList(found)],
      choices: [{ text: t("key.close"), value: null }],
      className: "wide",
    });
}

let said = () => {}; // ends the wait for the reading of the program before

/**
 * Say what is wrong with the program that was just loaded, once all of it has been read.
 * @param {string} id
 */
export function sayFindings(id) {
  said();
  const before = prompt.value;
  said = model.program.watch(({ loaded }) => {
    if (loaded?.id !== id || !loaded.checked) return;
    queueMicrotask(() => said());
    if (loaded.errors || loaded.warnings) void sayFirst(before);
  });
}

/** @param {object} before what was said when the program was loaded */
async function sayFirst(before) {
  /** @type {Found | null} */
  const found = await get("program").catch(refuse);
  const first = found?.findings.find((each) => each.severity === "error") ?? found?.findings[0];
  if (model.state.value.running) return; // the line is for what the program says now
  if (prompt.value.kind === "error" && prompt.value !== before) return; // or for a refusal since then
  if (found && first)
    prompt.set({
      kind: found.errors ? "error" : "say",
      text: `${summary(found)}: ${first.line}:${first.column} ${first.code} ${first.text}`,
    });
}

/** @param {Found} found */
function summary({ name, errors, warnings }) {
  return [
    name,
    errors ? t("findings.errors", { count: errors }) : "",
    warnings ? t("findings.warnings", { count: warnings }) : "",
  ]
    .filter(Boolean)
    .join(" \u00b7 ");
}
