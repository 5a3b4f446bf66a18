// What the search of the workspace finds: actions, panes, layouts, commands, pages of HELP, parameters, flags, lines.
import { get } from "../core/api.js";
import { model } from "../core/app.js";
import { h } from "../core/dom.js";
import { misfit } from "../core/fits.js";
import { t } from "../core/texts.js";
import { fullName } from "../frame/card_value.js";
import { ask } from "../frame/dialog.js";
import { ACTIONS } from "./actions.js";
import { giveByHand, isForHands } from "./command_dialog.js";
import { namedLayouts } from "./layouts.js";
import { actsOn } from "./names.js";
import { PANES } from "./panes.js";
import { arrange, mayCloseAll, openPane } from "./workspace.js";
import { want } from "./wanted.js";

/**
 * @typedef {{ label: import("../core/texts.js").Said, keys: string, does: () => unknown }} Act `keys`: with which the
 *   entry does this instead of its first act
 * @typedef {{ kind: Kind, title: string, detail: string, keys?: string, role?: string, words?: string, acts: Act[] }} Entry
 * @typedef {keyof typeof KINDS} Kind
 */

const TEXTS = {
  action: { en: "key", de: "Taste" },
  pane: { en: "pane", de: "Fenster" },
  layout: { en: "layout", de: "Anordnung" },
  command: { en: "command", de: "Befehl" },
  value: { en: "value", de: "Wert" },
  line: { en: "line", de: "Zeile" },
  help: { en: "help", de: "Hilfe" },
  open: { en: "open", de: "\u00f6ffnen" },
  give: { en: "give", de: "geben" },
  show: { en: "show", de: "zeigen" },
};

/** Kinds of entries: their names, the sign before which only they are found, and what they cost among others. */
export const KINDS = Object.freeze({
  action: { name: TEXTS.action, sign: ">", cost: 0 },
  pane: { name: TEXTS.pane, sign: ">", cost: 0 },
  layout: { name: TEXTS.layout, sign: ">", cost: 0 },
  command: { name: TEXTS.command, sign: ">", cost: 0.5 },
  value: { name: TEXTS.value, sign: "#", cost: 0.4 },
  line: { name: TEXTS.line, sign: ":", cost: 1 },
  help: { name: TEXTS.help, sign: "?", cost: 0.8 },
});
const MOST = 40; // of one search
const EXPLAINED = 6; // what an entry costs whose explanation alone has the words
const LEAST = 2; // letters from which values and lines are searched

/** Lines of the programs of the card, as they were read last. @type {Entry[]} */
let lines = [];
/** Commands and pages of HELP, by language. @type {{ language: string, entries: Entry[] } | null} */
let served = null;

/**
 * @param {Kind} kind
 * @param {string} title
 * @param {string} detail
 * @param {import("../core/texts.js").Said} label
 * @param {() => unknown} does
 * @returns {Entry}
 */
function entry(kind, title, detail, label, does) {
  return { kind, title, detail, acts: [{ label, keys: "Enter", does }] };
}

/** What is known without asking. @returns {Entry[]} */
function own() {
  const named = namedLayouts();
  return [
    ...Object.values(ACTIONS).map(({ title, keys, does }) => ({
      ...entry("action", t(title), "", TEXTS.show, does),
      keys,
    })),
    ...Object.entries(PANES).map(([pane, { title, role }]) => ({
      ...entry("pane", t(title), "", TEXTS.open, () => openPane(pane, { isNew: true })),
      role,
    })),
    ...Object.keys(named).map((name) =>
      entry("layout", name, "", TEXTS.open, async () => (await mayCloseAll()) && arrange(named[name])),
    ),
  ];
}

/** Read what only the server knows; `changed` is called with each part that has come. @param {() => void} changed */
export async function readEntries(changed) {
  await Promise.all([readServed().then(changed), readLines().then(changed)]);
}

async function readServed() {
  const language = document.documentElement.lang;
  if (served?.language === language) return;
  const [about, { keys: pages }] = await Promise.all([get("openapi.json"), get("help", { language })]);
  const commands = /** @type {[string, any][]} */ (Object.entries(about["x-commands"]));
  served = {
    language,
    entries: [
      ...commands
        .filter(([name, command]) => isForHands(name, command, about))
        .map(([name, command]) => {
          const title = command.titles?.[language] ?? name;
          const detail = title === name ? command.summary : `${name} \u2014 ${command.summary}`;
          return {
            ...entry("command", title, detail, TEXTS.give, () => giveByHand(name, title, command, about)),
            role: command.role,
            words: `${title} ${name}`,
          };
        }),
      ...Object.entries(pages)
        .filter(([key]) => !(key in about["x-commands"]))
        .map(([key, title]) => entry("help", String(title), "", TEXTS.show, () => showPage(key, language))),
    ],
  };
}

async function readLines() {
  const { programs } = await get("card/programs");
  const levels = programs.filter((/** @type {any} */ each) => each.used).map((/** @type {any} */ each) => each.name);
  const read = levels.map(async (/** @type {string} */ level) => {
    const [, word, number] = /^([A-Z]+)(\d+)$/.exec(level) ?? [];
    const listed = await get("card/listing", { [word === "PLC" ? "plc" : "program"]: number });
    return listed.lines.map((/** @type {{ number: number, text: string }} */ line) => ({
      ...entry("line", line.text, `${level} ${line.number}`, TEXTS.open, () =>
        want("editor", level, String(line.number)),
      ),
    }));
  });
  lines = (await Promise.all(read)).flat();
}

/**
 * @param {string} key
 * @param {string} language
 */
async function showPage(key, language) {
  const page = await get(`help/${key}`, { language });
  const text = page.text.split(/\n\s*\n/).map((/** @type {string} */ part) => h("p", {}, part));
  await ask({ title: page.title, body: text, choices: [{ text: t("key.close"), value: null }] });
}

/**
 * A parameter or flag.
 * @param {import("../frame/card_value.js").Item} item
 * @returns {Entry}
 */
function valueOf(item) {
  const detail = [item.id, item.section].filter(Boolean).join(" \u00b7 ");
  return {
    kind: "value",
    title: fullName(item),
    detail,
    words: `${fullName(item)} ${item.id} ${item.number}`,
    acts: actsOn(item.id),
  };
}

/**
 * The best entries for what is typed, the best first; those that the server finds come a moment later.
 * @param {string} typed
 * @param {import("../frame/card_value.js").Item[]} items that the server has found for it
 * @returns {Entry[]}
 */
export function found(typed, items) {
  const { sign, words } = partsOf(typed);
  const all = [
    ...own(),
    ...(served?.entries ?? []),
    ...(words.length >= LEAST || sign === ":" ? lines : []),
    ...items.map(valueOf),
  ];
  if (!words) return all.filter(({ kind }) => (sign ? KINDS[kind].sign === sign : kind === "action")).slice(0, MOST);
  return all
    .filter(({ kind }) => !sign || KINDS[kind].sign === sign)
    .map((each) => ({ each, cost: costOf(each, words) }))
    .filter(({ cost }) => cost < Number.POSITIVE_INFINITY)
    .sort((one, other) => one.cost - other.cost)
    .slice(0, MOST)
    .map(({ each }) => each);
}

/**
 * How badly an entry fits: by its title; of code and of explanations the letters as they are typed.
 * @param {Entry} entry
 * @param {string} words
 */
function costOf({ kind, title, detail, words: known }, words) {
  const [id] = detail.toLowerCase().split(" ");
  if (kind === "value" && [id, id.replace(/^(p|bit)(?=\d)/, "")].includes(words.toLowerCase())) return -1;
  const isThere = `${title} ${detail}`.toLowerCase().includes(words.toLowerCase());
  if (kind === "line") return (usesOf(words)?.test(title) ?? isThere) ? KINDS.line.cost : Number.POSITIVE_INFINITY;
  return KINDS[kind].cost + (misfit(known ?? title, words) ?? (isThere ? EXPLAINED : Number.POSITIVE_INFINITY));
}

/** Statements and contacts whose number is a flag. */
const OF_FLAG = "BIT|SET|CLR|INH|LD|AND|OR|OUT|NOT";

/**
 * What finds the lines with a parameter or flag by its number, however it is written; undefined for other words.
 * @param {string} words P12288 or BIT516
 */
function usesOf(words) {
  const [, sign, number] = /^(P|BIT)\s*(\d+)$/i.exec(words) ?? [];
  if (!number) return undefined;
  return new RegExp(`\\b(?:${sign.toUpperCase() === "P" ? "P" : OF_FLAG})\\s*\\(?\\s*-?${number}(?!\\d)`, "i");
}

/**
 * Have the server look for parameters and flags.
 * @param {string} typed
 * @returns {Promise<import("../frame/card_value.js").Item[]>}
 */
export async function searchValues(typed) {
  const { sign, words } = partsOf(typed);
  if (words.length < LEAST && !/^\d$/.test(words)) return [];
  if (sign && sign !== "#") return [];
  return (await get("card/search", { text: words, count: MOST })).items;
}

/** @param {string} typed */
function partsOf(typed) {
  const sign = /^[>#:?]/.exec(typed)?.[0] ?? "";
  return { sign, words: typed.slice(sign.length).trim() };
}

/** The role that an entry needs and this browser does not have; empty where it may do it. @param {Entry} entry */
export function roleFor({ role }) {
  return role && !model.may(role) ? role : "";
}
