// Symbols on the keys of the workspace: drawn here, a row for each command that has one in the field.
import { svg } from "../draw/svg.js";

const SIZE = 16;

/** Paths on a square of 16; those of FILLED are areas, all others lines. */
const SHAPES = {
  run: "M4 2.5 13 8 4 13.5Z",
  halt: "M3.5 3.5h9v9h-9Z",
  pause: "M4 3h3v10H4ZM9 3h3v10H9Z",
  resume: "M2.5 3h2.2v10H2.5ZM6.5 3 14 8l-7.5 5Z",
  step: "M3 3l7 5-7 5ZM11.3 3h2.2v10h-2.2Z",
  over: "M2 9.5A5.7 5.7 0 0 1 13 7M13.4 2.8V7.4H8.8M7.6 13h.8",
  into: "M8 1.5v7.3M4.6 5.6 8 9l3.4-3.4M7.6 13h.8",
  out: "M8 9.5V2M4.6 5 8 1.7 11.4 5M7.6 13h.8",
  breakpoint: "M8 3a5 5 0 1 0 .01 0Z",
  record: "M8 2a6 6 0 1 0 .01 0ZM8 6a2 2 0 1 0 .01 0Z",
  save: "M2.5 2.5h8.6l2.4 2.4v8.6h-11ZM5 2.8v3.7h5.5V2.8M5 13.2V9.5h6v3.7",
  store: "M1.5 13V3.5H6l1.5 2h7V13ZM8 7.2v4M6 9.4l2 2 2-2", // into a folder
  open: "M1.5 13V3.5H6l1.5 2h6v2M1.5 13l2-5.5h11.7L13.4 13Z",
  download: "M8 2v8.2M4.4 6.8 8 10.4l3.6-3.6M2.5 13.5h11",
  upload: "M8 10.4V2M4.4 5.4 8 1.8l3.6 3.6M2.5 13.5h11",
  undo: "M3 6h7a3.6 3.6 0 0 1 0 7.2H6M6.2 2.8 3 6l3.2 3.2",
  redo: "M13 6H6a3.6 3.6 0 0 0 0 7.2h4M9.8 2.8 13 6 9.8 9.2",
  zoom: "M7 2.5a4.5 4.5 0 1 0 .01 0ZM10.4 10.4 14 14M7 5v4M5 7h4",
  search: "M7 2.5a4.5 4.5 0 1 0 .01 0ZM10.4 10.4 14 14",
  fit: "M2.5 6V2.5H6M10 2.5h3.5V6M13.5 10v3.5H10M6 13.5H2.5V10",
  delete: "M3 4.5h10M6 4.2V2.5h4v1.7M4.3 4.8l.6 8.7h6.2l.6-8.7M6.8 7.2v3.8M9.2 7.2v3.8",
  settings: "M2 4.5h5M10.4 4.5H14M2 11.5h1.6M7 11.5h7M8.7 2.8a1.7 1.7 0 1 0 .01 0ZM5.3 9.8a1.7 1.7 0 1 0 .01 0Z",
};
/** @type {Set<keyof typeof SHAPES>} */
const FILLED = new Set(["run", "halt", "pause", "resume", "step", "breakpoint"]);

/** By the English text of a key, or by its own name where that means something else. */
const COMMANDS = /** @type {Record<string, keyof typeof SHAPES | "">} */ ({
  "tune.step": "", // a step of the position
  RUN: "run",
  START: "run",
  HALT: "halt",
  "STOP SCOPE": "halt",
  PAUSE: "pause",
  RESUME: "resume",
  "GO ON": "resume",
  STEP: "step",
  "STEP OVER": "over",
  "STEP INTO": "into",
  "STEP OUT": "out",
  "BREAKPOINTS: {count}": "breakpoint",
  RECORD: "record",
  SAVE: "save",
  "SAVE FILE": "save",
  "SAVE INTO PROJECT": "store",
  "OPEN FILE \u2026": "open",
  DOWNLOAD: "download",
  UPLOAD: "upload",
  UNDO: "undo",
  REDO: "redo",
  FIT: "fit",
  "ZOOM TO SELECTION": "zoom",
  CLEAR: "delete",
  "REMOVE ALL": "delete",
  SEARCH: "search",
  SETTINGS: "settings",
});

/**
 * The symbol of a command, in the colour of the text beside it; null where the field has none.
 * @param {...string} names of the command: the first that is in the table counts
 */
export function symbolOf(...names) {
  const name = COMMANDS[names.find((each) => each in COMMANDS) ?? ""];
  if (!name) return null;
  const element = svg("svg", {
    viewBox: `0 0 ${SIZE} ${SIZE}`,
    class: FILLED.has(name) ? "key-symbol is-filled" : "key-symbol",
    "aria-hidden": "true",
    "data-symbol": name,
  });
  element.append(svg("path", { d: SHAPES[name] }));
  return element;
}
