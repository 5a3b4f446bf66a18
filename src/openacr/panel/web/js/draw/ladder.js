// A rung of a PLC as a drawing: contacts, coils and boxes on the grid of the server, with the power that flows.
import { h, setText } from "../core/dom.js";
import { t } from "../core/texts.js";
import { svg } from "./svg.js";

const [WIDE, HIGH, MARGIN, TOP] = [92, 70, 14, 8];
const [ACROSS, MOST_LINES, LINE] = [16, 2, 11]; // of a name under its symbol: characters, lines, pixels
const RAIL = 0;

/**
 * @typedef {{ kind: string, text: string, flag: number | null, is_negated: boolean, number: number | null,
 *   column: number, row: number, source: number, sink: number, reset: number | null, reset_row: number | null }} Symbol
 * @typedef {{ net: number, column: number, row: number, to_column: number, to_row: number }} Wire
 * @typedef {{ line: number, columns: number, rows: number, nets: number, symbols: Symbol[], wires: Wire[] }} Rung
 * @typedef {(flag: number) => boolean | undefined} StateOf
 */

/**
 * Which nets of a rung carry power; none while its PLC is halted.
 * @param {Rung} rung
 * @param {StateOf} stateOf
 * @param {boolean} isRunning
 */
export function carried(rung, stateOf, isRunning) {
  const power = Array.from({ length: rung.nets }, (_each, net) => isRunning && net === RAIL);
  if (!isRunning) return power;
  for (const symbol of rung.symbols) {
    let passes = power[symbol.reset ?? symbol.source];
    if (symbol.kind === "contact") passes = passes && isClosed(symbol, stateOf);
    else if (symbol.kind === "not") passes = !passes;
    power[symbol.sink] = power[symbol.sink] || passes;
  }
  return power;
}

/**
 * Whether a contact is closed; one whose flag is not known yet is open.
 * @param {Symbol} symbol
 * @param {StateOf} stateOf
 */
function isClosed(symbol, stateOf) {
  const state = stateOf(symbol.flag ?? -1);
  return state !== undefined && state !== symbol.is_negated;
}

/**
 * Draw a rung; `update` shows which contacts are closed and where power flows.
 * @param {Rung} rung
 * @param {(flag: number) => string} nameOf names of inputs and outputs
 */
export function drawRung(rung, nameOf) {
  const [width, height] = [2 * MARGIN + rung.columns * WIDE, TOP + rung.rows * HIGH];
  /** @type {{ net: number, element: SVGElement }[]} */
  const wires = [];
  /** @type {{ symbol: Symbol, body: SVGElement, title: SVGElement }[]} */
  const symbols = [];
  const line = (/** @type {number} */ net, /** @type {number[]} */ [x1, y1, x2, y2]) => {
    const element = svg("line", { x1, y1, x2, y2, class: "wire" });
    wires.push({ net, element });
    return element;
  };
  const rails = [0, width].map((x, n) =>
    svg("line", { x1: x + (n ? -MARGIN : MARGIN), x2: x + (n ? -MARGIN : MARGIN), y1: 0, y2: height, class: "rail" }),
  );
  const parts = [
    ...rails,
    ...rung.wires.map((wire) =>
      line(wire.net, [atColumn(wire.column), atRow(wire.row), atColumn(wire.to_column), atRow(wire.to_row)]),
    ),
    ...rung.symbols.flatMap((symbol) => {
      const [body, title] = [svg("g", { class: `symbol ${symbol.kind}`, tabindex: -1, role: "img" }), svg("title", {})];
      if (symbol.flag !== null) body.dataset.item = `BIT${symbol.flag}`;
      body.append(title, ...shapeOf(symbol), ...textsOf(symbol, nameOf));
      symbols.push({ symbol, body, title });
      return [...stubsOf(symbol, line), body];
    }),
  ];
  const picture = svg("svg", {
    width,
    height,
    viewBox: `0 0 ${width} ${height}`,
    role: "group",
    class: "rung-picture",
  });
  picture.append(...parts);
  const element = h(
    "figure.rung",
    {},
    h("figcaption.rung-line.number", {}, String(rung.line)),
    h("div.rung-host", {}, picture),
  );
  return {
    element,
    /**
     * @param {StateOf} stateOf
     * @param {boolean} isRunning
     * @param {(kind: string, number: number) => string} countOf count and preload of a timer or counter
     */
    update(stateOf, isRunning, countOf) {
      const power = carried(rung, stateOf, isRunning);
      for (const { net, element: wire } of wires) wire.classList.toggle("is-live", power[net]);
      for (const { symbol, body, title } of symbols) {
        const isOn =
          symbol.kind === "contact" ? isClosed(symbol, stateOf) : symbol.flag !== null && stateOf(symbol.flag) === true;
        body.classList.toggle("is-on", isOn);
        const said = describe(symbol, stateOf, nameOf);
        setText(title, said);
        body.setAttribute("aria-label", said);
        const count = body.querySelector(".count");
        if (count && symbol.number !== null) setText(count, countOf(symbol.kind, symbol.number));
      }
      const ends = symbols.filter(({ symbol }) => !["contact", "not"].includes(symbol.kind));
      picture.setAttribute(
        "aria-label",
        [t("plc.rung", { line: rung.line }), ...ends.map(({ symbol }) => describe(symbol, stateOf, nameOf))].join(", "),
      );
    },
  };
}

/** @param {number} column */
const atColumn = (column) => MARGIN + column * WIDE;
/** @param {number} row */
const atRow = (row) => TOP + row * HIGH + HIGH / 2;

/**
 * The wires from the edges of a cell to its symbol.
 * @param {Symbol} symbol
 * @param {(net: number, points: number[]) => SVGElement} line
 */
function stubsOf(symbol, line) {
  const [x, y, middle] = [atColumn(symbol.column), atRow(symbol.row), atColumn(symbol.column) + WIDE / 2];
  const half = symbol.kind === "contact" ? 9 : symbol.number === null ? 14 : 34;
  const stubs = [line(symbol.source, [x, y, middle - half, y]), line(symbol.sink, [middle + half, y, x + WIDE, y])];
  if (symbol.reset !== null && symbol.reset_row !== null) {
    const low = atRow(symbol.reset_row);
    stubs.push(line(symbol.reset, [x, low, middle - half, low]));
  }
  return stubs;
}

const MARKS = Object.freeze({ set: "S", clear: "R", not: "NOT", coil: "", timer: "TIM", counter: "CNT", latch: "KR" });

/** @param {Symbol} symbol */
function shapeOf(symbol) {
  const [x, y] = [atColumn(symbol.column) + WIDE / 2, atRow(symbol.row)];
  const slash = symbol.is_negated
    ? [svg("line", { x1: x - 8, y1: y + 11, x2: x + 8, y2: y - 11, class: "slash" })]
    : [];
  if (symbol.kind === "contact") {
    const bars = [-9, 9].map((dx) => svg("line", { x1: x + dx, y1: y - 13, x2: x + dx, y2: y + 13, class: "bar" }));
    return [svg("rect", { x: x - 9, y: y - 13, width: 18, height: 26, class: "fill" }), ...bars, ...slash];
  }
  const mark = MARKS[/** @type {keyof typeof MARKS} */ (symbol.kind)];
  if (symbol.number === null) {
    const round = svg("rect", {
      x: x - 14,
      y: y - 13,
      width: 28,
      height: 26,
      rx: symbol.kind === "not" ? 3 : 13,
      class: "body fill",
    });
    return [round, ...slash, textAt(x, y + 4, mark, symbol.kind === "not" ? "mark small" : "mark")];
  }
  const low = symbol.reset_row === null ? y : atRow(symbol.reset_row);
  const box = svg("rect", { x: x - 34, y: y - 20, width: 68, height: low - y + 40, rx: 3, class: "body fill" });
  const inputs =
    symbol.reset_row === null
      ? []
      : [textAt(x - 27, y + 4, symbol.kind === "latch" ? "S" : "C", "small"), textAt(x - 27, low + 4, "R", "small")];
  const counts = symbol.kind === "latch" ? [] : [textAt(x + (inputs.length ? 5 : 0), y + 13, "", "count small")];
  return [box, ...inputs, textAt(x + (inputs.length ? 5 : 0), y - 2, `${mark} ${symbol.number}`, "mark"), ...counts];
}

/**
 * The flag over a symbol, its name under it.
 * @param {Symbol} symbol
 * @param {(flag: number) => string} nameOf
 */
function textsOf(symbol, nameOf) {
  if (symbol.flag === null || symbol.number !== null) return [];
  const [x, y] = [atColumn(symbol.column) + WIDE / 2, atRow(symbol.row)];
  const meant = nameOf(symbol.flag);
  const name = meant === symbol.text ? `BIT ${symbol.flag}` : meant; // it is written with its alias
  return [
    textAt(x, y - 18, symbol.text, "flag"),
    ...linesOf(name).map((line, n) => textAt(x, y + 24 + LINE * n, line, "small")),
  ];
}

/**
 * A name in as many lines as there is room for under a symbol.
 * @param {string} name
 */
function linesOf(name) {
  /** @type {string[]} */
  const lines = [];
  for (const word of name.split(/\s+/).filter(Boolean)) {
    const longer = lines.length ? `${lines[lines.length - 1]} ${word}` : word;
    if (lines.length && longer.length <= ACROSS) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  const shown = lines.slice(0, MOST_LINES);
  if (lines.length > MOST_LINES) shown[MOST_LINES - 1] += "\u2026";
  return shown.map((line) => (line.length > ACROSS ? `${line.slice(0, ACROSS - 1)}\u2026` : line));
}

/**
 * @param {number} x
 * @param {number} y
 * @param {string} text
 * @param {string} looks
 */
function textAt(x, y, text, looks) {
  const element = svg("text", { x, y, class: looks, "text-anchor": "middle" });
  element.textContent = text;
  return element;
}

/**
 * A symbol in words.
 * @param {Symbol} symbol
 * @param {StateOf} stateOf
 * @param {(flag: number) => string} nameOf
 */
function describe(symbol, stateOf, nameOf) {
  if (symbol.flag === null) return "NOT";
  const state = stateOf(symbol.flag);
  const what =
    symbol.number === null
      ? `BIT ${symbol.flag}`
      : `${MARKS[/** @type {keyof typeof MARKS} */ (symbol.kind)]} ${symbol.number}`;
  return `${[what, nameOf(symbol.flag)].filter(Boolean).join(" ")}: ${state === undefined ? "\u2013" : t(state ? "io.on" : "io.off")}`;
}
