// The page of `openacr verify --html`: the programs of a shop, what is wrong with them, and a filter.
import { h } from "../core/dom.js";

/** @type {any} */
const report = JSON.parse(document.getElementById("data")?.textContent ?? "{}");
const main = /** @type {HTMLElement} */ (document.getElementById("main"));

/** A time as h:mm:ss. @param {number | null} seconds */
function clock(seconds) {
  if (seconds === null) return "";
  const whole = Math.round(seconds);
  const two = (/** @type {number} */ value) => String(value).padStart(2, "0");
  return `${Math.floor(whole / 3600)}:${two(Math.floor(whole / 60) % 60)}:${two(whole % 60)}`;
}

/** The findings of a program below its row. @param {any} program */
function findings(program) {
  const notes = program.notes.map((/** @type {any} */ note) =>
    h(
      "li",
      { className: note.is_error ? "wrong" : "doubtful" },
      `${note.line}:${note.column} ${note.code} ${note.text}${note.hint ? ` (${note.hint})` : ""}`,
      note.file.endsWith(program.name) ? null : ` - ${note.file}`,
    ),
  );
  if (program.reason) notes.unshift(h("li", { className: "wrong" }, program.reason));
  return notes.length ? h("ul", {}, notes) : null;
}

/** @param {any} program */
function row(program) {
  const extents = Object.entries(program.extents)
    .map(([letter, [low, high]]) => `${letter} ${low.toFixed(3)} to ${high.toFixed(3)}`)
    .join(", ");
  const tools = program.tools
    .map((/** @type {number} */ tool) => (program.without_radius.includes(tool) ? `T${tool} (no radius)` : `T${tool}`))
    .join(" ");
  return h(
    "tr",
    { data: { status: program.status } },
    h("td", {}, h("b", {}, program.name), findings(program)),
    h("td", { className: program.is_good ? "good" : "wrong" }, program.status),
    h("td.number", {}, clock(program.time_s)),
    h("td.number", {}, program.lines),
    h("td", {}, tools),
    h("td", {}, extents, extents ? ` ${program.unit}` : ""),
  );
}

const rows = report.programs.map(row);

/** Show the programs of one status, or all. @param {string} status */
function show(status) {
  for (const each of rows) each.hidden = status !== "all" && each.dataset.status !== status;
}

const counts = Object.entries(report.counts).map(([status, count]) =>
  h("option", { value: status }, `${status} (${count})`),
);
const choice = h(
  "select",
  { ariaLabel: "Programs", onchange: () => show(choice.value) },
  h("option", { value: "all" }, `all (${rows.length})`),
  counts,
);
const heads = ["program", "result", "machine time", "lines", "tools", "extents"];
main.append(
  h("p", {}, "show ", choice),
  h(
    "table",
    {},
    h(
      "thead",
      {},
      h(
        "tr",
        {},
        heads.map((text) => h("th", {}, text)),
      ),
    ),
    h("tbody", {}, rows),
  ),
);
