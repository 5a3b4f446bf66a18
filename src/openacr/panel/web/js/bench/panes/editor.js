// Editor: controller files and the programs of the card, checked while they are typed, sent, compared, their running
// lines marked.
import { get, latest } from "../../core/api.js";
import { model, refuse, report } from "../../core/app.js";
import { fill, h, setText } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { CommandError } from "../../core/link.js";
import { chosenProgram, needPrograms } from "../../core/programs.js";
import { Endings } from "../../core/signal.js";
import { t } from "../../core/texts.js";
import { createControllerEditor } from "../../edit/controller_editor.js";
import { StoredLines } from "../../edit/line_marks.js";
import { ask, confirm } from "../../frame/dialog.js";
import { stateText } from "../../screens/programs.js";
import { firstLevel, fromCard, fromFile, levelOptions, toCard } from "../editor/card_text.js";
import { comparison } from "../editor/compare.js";
import { debugPart } from "../editor/debug_part.js";
import { nameActions } from "../editor/name_actions.js";
import { followPlaces } from "../editor/places_part.js";
import { problemList } from "../editor/problem_list.js";
import { keepInOneRow } from "../overflow.js";
import { projectPart } from "../editor/project_part.js";
import { valuesPart } from "../editor/values_part.js";

const TEXTS = {
  which: { en: "Program or file", de: "Programm oder Datei" },
  read: { en: "READ", de: "LESEN" },
  send: { en: "DOWNLOAD", de: "SENDEN" },
  compare: { en: "COMPARE", de: "VERGLEICHEN" },
  open: { en: "OPEN FILE \u2026", de: "DATEI \u00d6FFNEN \u2026" },
  save: { en: "SAVE FILE", de: "DATEI SPEICHERN" },
  uses: { en: "USES", de: "VERWENDUNG" },
  format: { en: "FORMAT", de: "FORMATIEREN" },
  outline: { en: "OUTLINE", de: "GLIEDERUNG" },
  close: { en: "CLOSE", de: "SCHLIESSEN" },
  beside: { en: "Beside the text", de: "Neben dem Text" },
  changed: { en: "changed", de: "ge\u00e4ndert" },
  runs: { en: "{name} runs: halt it first", de: "{name} l\u00e4uft: erst anhalten" },
  more: { en: "{count} more {count|finding|findings}", de: "{count} {count|weiterer Befund|weitere Befunde}" },
  downloadTitle: { en: "Download {name}?", de: "{name} senden?" },
  downloadText: {
    en: "The card stores the programs in this file and carries out all other lines at once: they can erase programs, change settings and move axes.",
    de: "Die Karte speichert die Programme dieser Datei und f\u00fchrt alle anderen Zeilen sofort aus: Sie k\u00f6nnen Programme l\u00f6schen, Einstellungen \u00e4ndern und Achsen bewegen.",
  },
  sent: {
    en: "{name}: {count} {count|line was|lines were} sent",
    de: "{name}: {count} {count|Zeile wurde|Zeilen wurden} gesendet",
  },
  noprogram: {
    en: "No line of this file is stored in a program",
    de: "Keine Zeile dieser Datei wird in einem Programm gespeichert",
  },
  notcompared: {
    en: "The text could not be compared: try again",
    de: "Der Text konnte nicht verglichen werden: noch einmal versuchen",
  },
};

const [SIGNATURE_MS, HALTED] = [150, "halted"];

/** @typedef {import("../editor/card_text.js").Opened} Opened */
const NEW_FILE = Object.freeze({ name: "setup.8k", level: "", text: "", version: "", setup: "", isCards: false });

/**
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head, kept, keep, beforeClose }) {
  const endings = new Endings();
  const newest = latest(endings);
  /** @type {Opened} */
  let opened = NEW_FILE;
  let saved = "";
  let drawnMarks = "";
  /** @type {StoredLines | null} */
  let stored = null; // of what is on the card for sure
  /** @type {import("../../edit/line_marks.js").LineMark | null} */
  let refused = null;
  /** @type {any[]} */
  let states = [];
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  /** @type {ReturnType<typeof createControllerEditor>} */
  let editor;

  const { problems, list } = problemList({
    goTo: (span) => {
      closeBeside();
      editor.goTo(span);
    },
    apply: (edits) => editor.apply(edits),
  });
  const actions = nameActions({ level: () => opened.level, asked, editor: () => editor, list, showBeside });
  const debug = debugPart({
    level: () => opened.level,
    editor: () => editor,
    stored: () => stored,
    known: async () => stored ?? (opened.isCards && !isChanged() ? storedOf(opened.level) : null),
    state: (level) => stateOf(level)?.state ?? "",
    drawMarks: () => editor && drawMarks(),
  });
  const values = valuesPart({
    isSeen: () => host.offsetParent !== null,
    state: (level) => stateOf(level)?.state,
    show: (say) => editor.showValues(say),
    draw: () => draw(),
  });
  const choice = h("select.field", { ariaLabel: t(TEXTS.which), onchange: () => void chooseLevel() });
  const input = h("input", {
    type: "file",
    hidden: true,
    ariaLabel: t(TEXTS.open),
    accept: ".8k,.8K,.txt,.prg",
    onchange: () => void chooseFile(),
  });
  const sendKey = keyOf(TEXTS.send, () => sendNow(), ".main");
  const project = projectPart({
    opened: () => opened,
    text: () => editor.text(),
    show: (now) => show(now),
    mayDrop: () => mayDrop(),
    draw: () => draw(),
  });
  head.append(
    choice,
    keyOf(TEXTS.read, () => chooseLevel()),
    sendKey,
    keyOf(TEXTS.compare, () => compare()),
    keyOf(TEXTS.open, () => input.click()),
    input,
    keyOf(TEXTS.save, () => save()),
    ...project.keys,
    keyOf("texts.rename", actions.rename),
    keyOf(TEXTS.uses, actions.uses),
    keyOf(TEXTS.format, actions.format),
    keyOf(TEXTS.outline, actions.outline),
    values.key,
  );
  endings.add(keepInOneRow(head));
  const code = h("div.editor-host.grow", {});
  const beside = h("div.stack.scroll.text-beside", {
    hidden: true,
    tabIndex: 0,
    role: "region",
    ariaLabel: t(TEXTS.beside),
  });
  const signature = h("div.mono.text-signature", { ariaLive: "off" });
  const status = h("span.hint.grow", { role: "status" });
  host.classList.add("is-editor");
  host.append(
    debug.bar,
    h("div.text-work.grow", {}, code, beside),
    problems,
    h("div.row.text-foot", {}, status, signature),
  );

  const isChanged = () => editor.text() !== saved;
  const stateOf = (/** @type {string} */ level) => states.find((each) => each.name === level);

  /** @param {Opened} now */
  function show(now) {
    opened = now;
    saved = now.isCards ? now.text : "";
    stored = null;
    refused = null;
    drawnMarks = "";
    if (editor) editor.close();
    values.seen([]);
    editor = createControllerEditor(code, {
      ...now,
      found: showFindings,
      changed,
      moved,
      named: values.seen,
      ...debug.editing(actions.keys),
    });
    closeBeside();
    choice.value = now.level;
    if (now.level) chosenProgram.set(now.level);
    if (now.isCards) void knowStored([now.level]);
    draw();
  }

  // --- what is shown ------------------------------------------------------------------

  function draw() {
    const state = stateOf(opened.level);
    const isRunning = state !== undefined && state.state !== HALTED;
    sendKey.disabled = !model.may("service") || isRunning;
    sendKey.title = isRunning
      ? t(TEXTS.runs, { name: opened.level })
      : model.may("service")
        ? t(TEXTS.send)
        : t("role.needed", { role: t("role.service") });
    project.draw();
    debug.draw();
    const about = [
      opened.level || opened.name,
      state ? stateText(state) : "",
      t("edit.lines", { count: editor.doc().lines }),
      isChanged() ? t(TEXTS.changed) : "",
      project.differs(),
      values.why(),
    ];
    setText(status, about.filter(Boolean).join(" \u00b7 "));
    drawMarks();
  }

  function drawMarks() {
    /** @type {import("../../edit/line_marks.js").LineMark[]} */
    const marks = [...(refused ? [refused] : []), ...debug.marks()];
    for (const { name, line } of states) {
      const at = line && stored && !debug.holds(name) ? stored.at(name, line) : null;
      if (at !== null) marks.push({ at, kind: "running", text: name });
    }
    const drawn = JSON.stringify(marks);
    if (drawn === drawnMarks) return;
    drawnMarks = drawn;
    editor.mark(marks);
  }

  /**
   * The card holds these programs as the text has them now.
   * @param {string[]} levels
   */
  async function knowStored(levels) {
    const mine = editor;
    const answered = await mine.synced.ask("stored");
    if (!answered?.answer || mine !== editor || answered.doc !== mine.doc()) return;
    stored = new StoredLines(
      Object.fromEntries(levels.filter((each) => each in answered.answer).map((each) => [each, answered.answer[each]])),
      answered.doc,
    );
    drawMarks();
  }

  /** @param {string} level */
  async function storedOf(level) {
    if (!stored) await knowStored([level]);
    return stored;
  }

  /** @param {import("../../../vendor/codemirror.js").ChangeSet} changes */
  function changed(changes) {
    stored?.changed(changes);
    refused = null;
    drawnMarks = "";
    queueMicrotask(draw); // the editor takes no other change within one
  }

  function moved() {
    clearTimeout(timer);
    timer = setTimeout(async () => {
      const answered = await editor.synced.ask("signature", editor.about());
      if (!answered || answered.doc !== editor.doc()) return;
      const found = answered.answer;
      fill(
        signature,
        ...(found
          ? [found.label, ...(found.active >= 0 ? [" \u00b7 ", h("strong", {}, found.parts[found.active])] : [])]
          : []),
      );
    }, SIGNATURE_MS);
  }

  /**
   * @param {import("../../edit/language.js").Finding[]} findings
   * @param {number} more
   */
  function showFindings(findings, more) {
    list(
      findings.map(({ span, text, is_warning, fix }) => ({ span, text, kind: is_warning ? "warning" : "error", fix })),
    );
    if (more) problems.append(h("p.hint", {}, t(TEXTS.more, { count: more })));
  }

  /** @param {...Node} content */
  function showBeside(...content) {
    fill(beside, h("div.row", {}, h("span.grow", {}), keyOf(TEXTS.close, closeBeside)), ...content);
    beside.hidden = false;
  }

  function closeBeside() {
    beside.hidden = true;
  }

  /**
   * Ask about the present text; what is refused goes to the prompt line.
   * @param {string} question
   * @param {object} [about]
   */
  async function asked(question, about = editor.about()) {
    const answered = await editor.synced.ask(question, about);
    if (!answered || answered.doc !== editor.doc()) return null;
    if (answered.refusal) refuse(answered.refusal);
    return answered.answer;
  }

  // --- files and the card -------------------------------------------------------------

  async function mayDrop() {
    if (!isChanged()) return true;
    const chosen = await ask({
      title: t("edit.leave"),
      body: [h("p", {}, t("edit.leave.text", { name: opened.level || opened.name }))],
      choices: [
        { text: t("key.cancel"), value: "stay" },
        { text: t("form.drop"), value: "drop", kind: "danger" },
        ...(project.maySave() ? [{ text: t("texts.project.save"), value: "project" }] : []),
        ...(!opened.level
          ? [{ text: t(TEXTS.save), value: "file" }]
          : sendKey.disabled
            ? []
            : [{ text: t(TEXTS.send), value: "send" }]),
      ],
    });
    if (chosen === "project") return project.save();
    if (chosen === "file") save();
    else if (chosen === "send") await sendNow();
    else return chosen === "drop";
    return !isChanged();
  }

  /** @param {Opened | Promise<Opened>} reading */
  const open = (reading) => newest(Promise.resolve(reading)).then((now) => now && show(now), refuse);

  async function chooseLevel() {
    const level = choice.value;
    if (!(await mayDrop())) choice.value = opened.level;
    else {
      keep({ level });
      await open(level ? fromCard(level) : NEW_FILE);
    }
  }

  async function chooseFile() {
    const [file] = input.files ?? [];
    input.value = "";
    if (!file || !(await mayDrop())) return;
    keep({ level: "" });
    await open(fromFile(file));
  }

  function save() {
    const link = h("a", {
      href: URL.createObjectURL(new Blob([editor.text()], { type: "text/plain" })),
      download: opened.name,
    });
    link.click();
    URL.revokeObjectURL(link.href);
    if (!opened.level) {
      saved = editor.text();
      draw();
    }
  }

  async function sendNow() {
    const text = editor.text();
    const sent = opened;
    const isLeft = () => opened !== sent; // another text was opened while an answer was waited for
    if (
      !opened.level &&
      !(await confirm(t(TEXTS.downloadTitle, { name: opened.name }), t(TEXTS.downloadText), t(TEXTS.send)))
    )
      return;
    try {
      const done = await toCard(sent, text);
      report(t(TEXTS.sent, { name: sent.level || sent.name, count: done.sent }));
      const version = sent.level ? (await fromCard(sent.level)).version : sent.version;
      if (isLeft()) return;
      list(
        (done.remarks ?? []).map(([line, remark]) => ({
          span: [line - 1, 0, line - 1, 0],
          text: remark,
          kind: "remark",
        })),
      );
      refused = null;
      saved = text;
      opened = { ...sent, version };
      await knowStored(opened.level ? [opened.level] : states.map((each) => each.name));
    } catch (error) {
      if (isLeft() || !(error instanceof CommandError)) refuse(error);
      else await notTaken(error);
    }
    draw();
  }

  /** @param {CommandError} error */
  async function notTaken(error) {
    if (error.code === "conflict") {
      const isSure = await ask({
        title: t("edit.conflict"),
        body: [h("p", {}, error.message)],
        choices: [
          { text: t("key.cancel"), value: false },
          { text: t(TEXTS.compare), value: "compare" },
          { text: t("edit.overwrite"), kind: "danger", value: true },
        ],
      });
      if (isSure === "compare") await compare();
      else if (isSure) {
        opened = { ...opened, version: "" };
        await sendNow();
      }
      return;
    }
    refuse(error.message);
    const line = /** @type {any} */ (error.refusal).line;
    if (!line || line > editor.doc().lines) return;
    editor.goTo([line - 1, 0, line - 1, 0]);
    refused = { at: editor.doc().line(line).from, kind: "refused", text: error.message };
  }

  async function compare() {
    const entered = await asked("stored");
    if (!entered) return;
    const programs = opened.level ? [opened.level] : Object.keys(entered);
    const found = await asked("compare", { programs });
    if (!found) {
      refuse(t(TEXTS.notcompared));
      return;
    }
    showBeside(
      ...found.map((/** @type {any} */ each) => comparison(each, (line) => editor.goTo([line - 1, 0, line - 1, 0]))),
      ...(found.length ? [] : [h("p.hint", {}, t(TEXTS.noprogram))]),
    );
    await knowStored(
      found.filter((/** @type {any} */ each) => each.is_equal).map((/** @type {any} */ each) => each.name),
    );
  }

  // --- begin and end ------------------------------------------------------------------

  const leaving = (/** @type {BeforeUnloadEvent} */ event) => {
    if (isChanged()) event.preventDefault();
  };
  window.addEventListener("beforeunload", leaving);
  beforeClose(mayDrop);
  show(opened);
  endings.add(
    () => window.removeEventListener("beforeunload", leaving),
    () => clearTimeout(timer),
    () => editor.close(),
    needPrograms(),
    model.programs.watch(({ programs }) => {
      states = programs;
      values.follow();
      draw();
    }),
    project.watch(),
    debug.watch(),
    values.watch(),
  );
  const { programs } = await get("card/programs");
  fill(choice, ...levelOptions(programs));
  choice.value = firstLevel(programs, kept.level, chosenProgram.value);
  if (choice.value && (kept.level || !isChanged()))
    await open(fromCard(choice.value)); // no choice: it is not kept
  else choice.value = opened.level;
  endings.add(followPlaces({ opened: () => opened, stored: storedOf, editor: () => editor, choice, chooseLevel }));
  return () => endings.end();
}
