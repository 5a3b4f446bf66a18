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
import { setupDiffers, setupPart } from "../project_setup.js";
import { want } from "../wanted.js";

const SETUP = "setup.8k";
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
  upload: { en: "UPLOAD", de: "HOLEN" },
  downloadAll: { en: "DOWNLOAD ALL", de: "ALLE LADEN" },
  uploadAll: { en: "UPLOAD ALL", de: "ALLE HOLEN" },
  toEditor: { en: "INTO THE EDITOR", de: "IN DEN EDITOR" },
  toFolder: { en: "INTO THE FOLDER", de: "IN DEN ORDNER" },
  editorText: {
    en: "INTO THE EDITOR opens the text of the card there, and asks where that would lose changes; the folder stays as it is.",
    de: "IN DEN EDITOR öffnet dort den Text der Karte und fragt, wo das Änderungen kosten würde; der Ordner bleibt, wie er ist.",
  },
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
  const setup = setupPart(endings);
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
    upload: keyOf(
      TEXTS.uploadAll,
      () =>
        void toSide(
          "project",
          texts.filter(({ state }) => isOther(state, "project")),
          true,
        ),
    ),
  };
  head.append(
    keyOf("programs.read", () => void Promise.all([read(), setup.read()])),
    all.download,
    all.upload,
  );
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
      setup.element,
    ),
  );
  const newest = latest(endings);

  async function read() {
    const found = await newest(get("project")).catch((error) => void refuse(error));
    if (!found) return;
    texts = found.texts;
    drawKeys();
    fill(table, ...texts.map(rowOf));
  }

  function drawKeys() {
    const may = model.may("service");
    all.download.disabled = !may || !texts.some(({ state }) => isOther(state, "card"));
    all.upload.disabled = !may || !(setup.differs() || texts.some(({ state }) => isOther(state, "project")));
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
          isOther(state, "project") ? key(TEXTS.upload, () => void toSide("project", [text])) : "",
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
   * @param {boolean} [isAll] with the set-up
   */
  async function toSide(side, wanted, isAll = false) {
    const done = [];
    const withSetup = isAll && setup.differs() > 0;
    const names = [...wanted.map(({ name }) => name), ...(withSetup ? [SETUP] : [])];
    try {
      const lost = await Promise.all(wanted.map(({ name }) => lines(name, side)));
      if (withSetup) lost.push([SETUP, setup.lost()]);
      const chosen = await ask(question(side, lost, isAll));
      if (!chosen) return;
      if (chosen === "editor") return want("editor", wanted[0].name, "", "read");
      for (const { name } of wanted) {
        await (side === "card" ? download(name) : save(name));
        done.push(name);
      }
      if (withSetup) {
        await setup.store();
        done.push(SETUP);
      }
    } catch (error) {
      refuse(error);
    }
    if (done.length === names.length) report(t(side === "card" ? TEXTS.sent : TEXTS.saved, { names: done.join(", ") }));
    fill(seen);
    await read();
  }

  endings.add(setupDiffers.watch(drawKeys));
  void setup.read();
  endings.add(model.texts.watch(() => void read()));
  return () => endings.end();
}

/**
 * The question before texts are replaced: what is lost.
 * @param {"card" | "project"} side that is changed
 * @param {[string, number][]} lost names, and how many lines of each
 * @param {boolean} isAll
 */
function question(side, lost, isAll) {
  const isUpload = side === "project";
  const hasEditor = isUpload && !isAll;
  return {
    title: t(isUpload ? TEXTS.upload : TEXTS.download),
    body: [
      h("p", {}, t(isUpload ? TEXTS.lostFolder : TEXTS.lostCard)),
      h("ul", {}, ...lost.map(([name, count]) => h("li", {}, t(count ? TEXTS.loses : TEXTS.nothing, { name, count })))),
      hasEditor ? h("p", {}, t(TEXTS.editorText)) : "",
    ],
    choices: /** @type {import("../../frame/dialog.js").Choice[]} */ ([
      { text: t("key.cancel"), value: null },
      ...(hasEditor ? [{ text: t(TEXTS.toEditor), value: "editor" }] : []),
      { text: t(isUpload ? TEXTS.toFolder : TEXTS.download), kind: "danger", value: "side" },
    ]),
  };
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
