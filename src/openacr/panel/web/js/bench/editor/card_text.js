// Texts on their way from the card and to it.
import { get, send } from "../../core/api.js";
import { link, model, refuse } from "../../core/app.js";
import { h } from "../../core/dom.js";
import { firstProgram } from "../../core/programs.js";
import { t } from "../../core/texts.js";
import { textOf } from "../../screens/programs.js";

const TEXTS = { file: { en: "File", de: "Datei" } };

const OF_CARD = /^(prog|plc)(\d+)\.8k$/i;

/**
 * @typedef {{ file: string, text: string, version: string, is_same: boolean, why_not: string }} InProject how the
 *   project of the card has a program
 * @typedef {{ name: string, level: string, text: string, version: string, setup: string, isCards: boolean,
 *   project?: InProject | null }} Opened
 *   `level` is that of a program of the card, empty for a whole file; `version` that of the listing it replaces
 */

/** @param {string} level PROG3 or PLC0 */
export function which(level) {
  return level.startsWith("PLC") ? { plc: Number(level.slice(3)) } : { program: Number(level.slice(4)) };
}

/**
 * A program as the card lists it; where its project has the same, as it is written there, with its comments. A project
 * that cannot be read is said.
 * @param {string} level
 * @returns {Promise<Opened>}
 */
export async function fromCard(level) {
  const [listed, around, project] = await Promise.all([
    get("card/listing", which(level)),
    get("card/surroundings", which(level)),
    inProject(level).catch((error) => void refuse(error)),
  ]);
  const text = project?.is_same && project.text ? project.text : textOf(listed.lines);
  return {
    name: `${level.toLowerCase()}.8k`,
    level,
    text,
    version: listed.version,
    setup: around.setup,
    isCards: true,
    project,
  };
}

/** Whether the card belongs to a project, whose folder has its programs. */
export const hasProject = () => model.hello.value.machine.kind === "project";

/**
 * A program as the project of the card has it; null where there is none.
 * @param {string} level
 * @returns {Promise<InProject | null>}
 */
export async function inProject(level) {
  return level && hasProject() ? get("project/text", which(level)) : null;
}

/**
 * Store a text in the folder of the project.
 * @param {Opened} opened
 * @param {string} text
 */
export function toProject({ level, project }, text) {
  return send("POST", "project/text", { name: level, text, version: project?.version ?? "" });
}

/**
 * A file of this computer: prog3.8k is the text of a program, other names are whole files.
 * @param {File} file
 * @returns {Promise<Opened>}
 */
export async function fromFile(file) {
  const text = (await file.text()).replace(/\r\n?/g, "\n");
  const name = /\.8k$/i.test(file.name) ? file.name : `${file.name.replace(/\.[^.]*$/, "")}.8k`;
  const match = OF_CARD.exec(name);
  if (!match) return { name, level: "", text, version: "", setup: "", isCards: false };
  const there = await fromCard(`${match[1].toUpperCase()}${Number(match[2])}`);
  return { ...there, text, isCards: false };
}

/**
 * Send a text to the card; refused, the CommandError names the line.
 * @param {Opened} opened
 * @param {string} text
 * @returns {Promise<{ sent: number, remarks?: [number, string][] }>}
 */
export async function toCard({ level, version }, text) {
  const { parked } = await send("POST", "text/parked", { text });
  return level
    ? link.command("card.send", { ...which(level), parked, version })
    : link.command("card.download", { parked });
}

/**
 * What can be opened: a file, and the programs that have memory.
 * @param {{ name: string, bytes: number }[]} programs
 */
export function levelOptions(programs) {
  const names = programs.filter((each) => each.bytes).map((each) => each.name);
  return [h("option", { value: "" }, t(TEXTS.file)), ...names.map((name) => h("option", { value: name }, name))];
}

/**
 * The program to show first; "" for a file.
 * @param {any[]} programs
 * @param {string | undefined} kept "" for a file, undefined where no choice was made
 * @param {string} chosen in another pane
 */
export function firstLevel(programs, kept, chosen) {
  const wanted = kept ?? (chosen || firstProgram(programs));
  return programs.some((each) => each.bytes && each.name === wanted) ? wanted : "";
}
