// PROJECT: each program of the card beside that of its project's folder; what differs goes to one of the two sides.
import { get, latest } from "../../core/api.js";
import { model, refuse, report } from "../../core/app.js";
import { fill, h } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { Endings } from "../../core/signal.js";
import { t } from "../../core/texts.js";
import { ask } from "../../frame/dialog.js";
import { textOf } from "../../screens/programs.js";
import { hasProject, inProject, toCard, toProject, which } from "../editor/card_text.js";
import { comparison } from "../editor/compare.js";

const TEXTS = {
  none: {
    en: "This card has no project. `openacr panel FOLDER` opens one: its programs are then compared with those of the card.",
    de: "Diese Karte hat kein Projekt. `openacr panel ORDNER` öffnet eines: Seine Programme werden dann mit denen der Karte verglichen.",
  },
  text: { en: "Text", de: "Text" },
  state: { en: "Card and project", de: "Karte und Projekt" },
  equal: { en: "equal", de: "gleich" },
  differs: { en: "differs", de: "verschieden" },
  card: { en: "only on the card", de: "nur auf der Karte" },
  project: { en: "only in the project", de: "nur im Projekt" },
  beside: { en: "COMPARE", de: "VERGLEICHEN" },
  download: { en: "DOWNLOAD", de: "LADEN" },
  save: { en: "SAVE INTO PROJECT", de: "INS PROJEKT SPEICHERN" },
  downloadAll: { en: "DOWNLOAD ALL", de: "ALLE LADEN" },
  saveAll: { en: "SAVE ALL", de: "ALLE SPEICHERN" },
  folder: { en: "In the project", de: "Im Projekt" },
  lostCard: {
    en: "The card gets the texts of the project. What is lost on the card:",
    de: "Die Karte bekommt die Texte des Projekts. Auf der Karte geht verloren:",
  },
  lostFolder: {
    en: "The project gets the texts of the card, which has no comments. What is lost in the project:",
    de: "Das Projekt bekommt die Texte der Karte, die keine Kommentare hat. Im Projekt geht verloren:",
  },
  loses: { en: "{name}: {count} {count|line|lines}", de: "{name}: {count} {count|Zeile|Zeilen}" },
  nothing: { en: "{name}: nothing", de: "{name}: nichts" },
  sent: { en: "On the card now: {names}", de: "Jetzt auf der Karte: {names}" },
  saved: { en: "In the project now: {names}", de: "Jetzt im Projekt: {names}" },
};

/** @typedef {{ name: string, state: "equal" | "differs" | "card" | "project" }} Text */

/**
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head }) {
  const endings = new Endings();
  if (!hasProject()) {
    host.append(h("p.hint", {}, t(TEXTS.none)));
    return () => endings.end();
  }
  const table = h("tbody", {});
  const seen = h("div.stack", {});
  /** @type {Text[]} */
  let texts = [];
  const all = {
    download: keyOf(
      TEXTS.downloadAll,
      () =>
        void toSide(
          "card",
          texts.filter(({ state }) => isOther(state, "card")),
        ),
    ),
    save: keyOf(
      TEXTS.saveAll,
      () =>
        void toSide(
          "project",
          texts.filter(({ state }) => isOther(state, "project")),
        ),
    ),
  };
  head.append(all.download, all.save);
  host.append(
    h(
      "div.grow.scroll",
      { tabIndex: 0 },
      h(
        "table.grid",
        {},
        h("thead", {}, h("tr", {}, h("th", {}, t(TEXTS.text)), h("th", {}, t(TEXTS.state)), h("th", {}))),
        table,
      ),
      seen,
    ),
  );
  const newest = latest(endings);

  async function read() {
    const found = await newest(get("project")).catch((error) => void refuse(error));
    if (!found) return;
    texts = found.texts;
    for (const [key, side] of /** @type {const} */ ([
      [all.download, "card"],
      [all.save, "project"],
    ]))
      key.disabled = !model.may("service") || !texts.some(({ state }) => isOther(state, side));
    fill(table, ...texts.map(rowOf));
  }

  /** @param {Text} text */
  function rowOf(text) {
    const { name, state } = text;
    const key = (/** @type {import("../../core/texts.js").Text} */ label, /** @type {() => void} */ act) =>
      keyOf(label, act, "", { ariaLabel: `${t(label)} ${name}` });
    return h(
      "tr",
      { data: { name } },
      h("th", { scope: "row" }, name),
      h(state === "equal" ? "td" : "td.program-differs", { data: { state } }, t(TEXTS[state])),
      h(
        "td",
        {},
        h(
          "div.row.wrap",
          {},
          state === "equal" ? "" : key(TEXTS.beside, () => void compare(name)),
          isOther(state, "card") ? key(TEXTS.download, () => void toSide("card", [text])) : "",
          isOther(state, "project") ? key(TEXTS.save, () => void toSide("project", [text])) : "",
        ),
      ),
    );
  }

  /** @param {string} name */
  async function compare(name) {
    const found = await get("project/compare", which(name)).catch((error) => void refuse(error));
    if (found)
      fill(
        seen,
        comparison(found, () => {}, t(TEXTS.folder)),
      );
  }

  /**
   * Have texts of one side replaced by those of the other, once it was said what is lost.
   * @param {"card" | "project"} side that is changed
   * @param {Text[]} wanted
   */
  async function toSide(side, wanted) {
    const done = [];
    try {
      const lost = await Promise.all(wanted.map(({ name }) => lines(name, side)));
      const title = t(side === "card" ? TEXTS.download : TEXTS.save);
      const isSure = await ask({
        title,
        body: [
          h("p", {}, t(side === "card" ? TEXTS.lostCard : TEXTS.lostFolder)),
          h(
            "ul",
            {},
            ...lost.map(([name, count]) => h("li", {}, t(count ? TEXTS.loses : TEXTS.nothing, { name, count }))),
          ),
        ],
        choices: [
          { text: t("key.cancel"), value: null },
          { text: title, kind: "danger", value: true },
        ],
      });
      if (!isSure) return;
      for (const { name } of wanted) {
        await (side === "card" ? download(name) : save(name));
        done.push(name);
      }
    } catch (error) {
      refuse(error);
    }
    if (done.length === wanted.length)
      report(t(side === "card" ? TEXTS.sent : TEXTS.saved, { names: done.join(", ") }));
    fill(seen);
    await read();
  }

  endings.add(model.texts.watch(() => void read()));
  return () => endings.end();
}

/**
 * Whether a text can go to a side, since the other one has another.
 * @param {Text["state"]} state
 * @param {"card" | "project"} side
 */
function isOther(state, side) {
  return state === "differs" || state === (side === "card" ? "project" : "card");
}

/**
 * How many lines of a side the other one does not have.
 * @param {string} name
 * @param {"card" | "project"} side
 * @returns {Promise<[string, number]>}
 */
async function lines(name, side) {
  const { rows } = await get("project/compare", which(name));
  const has = (/** @type {import("../editor/compare.js").Row} */ [line, , , listed]) =>
    side === "card" ? listed : line;
  return [name, rows.filter((/** @type {import("../editor/compare.js").Row} */ row) => !row[4] && has(row)).length];
}

/** @param {string} name */
async function download(name) {
  const [listed, project] = await Promise.all([get("card/listing", which(name)), inProject(name)]);
  if (!project || project.why_not) throw new Error(project?.why_not);
  await toCard({ name, level: name, text: "", version: listed.version, setup: "", isCards: false }, project.text);
}

/** @param {string} name */
async function save(name) {
  const [listed, project] = await Promise.all([get("card/listing", which(name)), inProject(name)]);
  if (!project || project.why_not) throw new Error(project?.why_not);
  await toProject(
    { name, level: name, text: "", version: "", setup: "", isCards: true, project },
    textOf(listed.lines),
  );
}
