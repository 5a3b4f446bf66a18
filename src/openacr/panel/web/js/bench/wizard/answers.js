// The answers of the wizard as the tables of configure.toml, and where in them a dialog has its own.

/**
 * @typedef {{ key: string, title: string, unit: string, help: string,
 *   kind: "switch" | "count" | "number" | "text" | "choice" | "pair" | "names", is_optional: boolean, default: any,
 *   choices?: string[], low?: number, high?: number }} Row
 * @typedef {{ name: string, title: string, of: "card" | "axis" | "master", within: string, rows: Row[] }} Dialog
 * @typedef {{ card?: Record<string, any>, axis: Record<string, any>[], master?: Record<string, any>[] }} Answers
 * @typedef {(string | number)[]} Where keys and places of a value in the tables
 */

/**
 * Where a dialog has its values.
 * @param {Dialog} dialog
 * @param {number} place of the axis or master
 * @returns {Where}
 */
export function whereOf(dialog, place) {
  return [dialog.of, ...(dialog.of === "card" ? [] : [place]), ...(dialog.within ? [dialog.within] : [])];
}

/**
 * @param {Answers} answers
 * @param {Where} where
 * @returns {any} the table or value there, undefined if it is as by default
 */
export function valueAt(answers, where) {
  return where.reduce((/** @type {any} */ table, key) => table?.[key], answers);
}

/**
 * The answers with another value; undefined takes it out. Tables without a value go with it.
 * @param {any} table
 * @param {Where} where
 * @param {any} value
 * @returns {any}
 */
export function changed(table, [key, ...rest], value) {
  const copy = Array.isArray(table) ? [...table] : { ...table };
  const next = rest.length ? changed(copy[key] ?? {}, rest, value) : value;
  const isEmpty =
    next === undefined ||
    (!Array.isArray(copy) && typeof next === "object" && !Array.isArray(next) && !Object.keys(next).length);
  if (isEmpty && !Array.isArray(copy)) delete copy[key];
  else copy[key] = next ?? {};
  return copy;
}

/**
 * An axis or master more, with the first number and name that are free.
 * @param {Answers} answers
 * @param {"axis" | "master"} what
 * @returns {Answers}
 */
export function withOneMore(answers, what) {
  const there = answers[what] ?? [];
  const number = firstFree(
    there.map((each) => each.number),
    (n) => n,
  );
  if (what === "master") return { ...answers, master: [...there, { number, axes: [] }] };
  const name = firstFree(
    there.map((each) => each.name),
    (n) => "XYZABCUVW"[n] ?? `A${String.fromCharCode(65 + n - 9)}`,
  );
  const last = there.at(-1) ?? { units_per_rev: 5, counts_per_rev: 8000 };
  return {
    ...answers,
    axis: [...there, { number, name, units_per_rev: last.units_per_rev, counts_per_rev: last.counts_per_rev }],
  };
}

/**
 * @template T
 * @param {T[]} taken
 * @param {(n: number) => T} of
 * @returns {T}
 */
function firstFree(taken, of) {
  let n = 0;
  while (taken.includes(of(n))) n++;
  return of(n);
}

/**
 * What is typed, as a value of the file; undefined: as by default. Text that is no value stays text, for the server to
 * refuse.
 * @param {Row} row
 * @param {string} text
 */
export function valueOf(row, text) {
  const typed = text.trim();
  if (row.kind === "names") return typed ? typed.split(/[\s,]+/) : [];
  if (row.kind === "pair") return typed ? typed.split(/[\s;]+|,\s+/).map(numberOf) : undefined;
  const value =
    row.kind === "switch"
      ? typed
        ? typed === "1"
        : null
      : row.kind === "text" || row.kind === "choice"
        ? typed
        : typed
          ? numberOf(typed)
          : null;
  return value === row.default || (value === null && row.default !== undefined && row.is_optional)
    ? undefined
    : (value ?? undefined);
}

/** @param {string} text */
function numberOf(text) {
  const number = Number(text.replace(",", "."));
  return text && Number.isFinite(number) ? number : text;
}

/**
 * A value as it is typed.
 * @param {Row} row
 * @param {any} value
 */
export function textOf(row, value) {
  const shown = value === undefined ? row.default : value;
  if (shown === null || shown === undefined) return "";
  if (row.kind === "switch") return shown ? "1" : "0";
  return Array.isArray(shown) ? shown.join(", ") : String(shown);
}
