// EDIT: part programs in an editor with colours and findings; the loaded program cannot be changed while it runs.
import { ApiError, latest, readFile, send, writeFile } from "../core/api.js";
import { model, refuse, report } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { ask, askText } from "../frame/dialog.js";
import { findingItems } from "../frame/findings.js";
import { openScreen } from "../frame/screen_host.js";
import { fileList } from "../load/file_list.js";

const TEXTS = {
  title: { en: "Edit", de: "Editor" },
  dxf: { en: "DXF", de: "DXF" },
  open: { en: "OPEN", de: "ÖFFNEN" },
  new: { en: "NEW", de: "NEU" },
  save: { en: "SAVE", de: "SPEICHERN" },
  saveas: { en: "SAVE AS", de: "SPEICHERN ALS" },
  unnamed: { en: "new file", de: "neue Datei" },
  locked: {
    en: "This program runs: it cannot be changed now",
    de: "Dieses Programm läuft: Es lässt sich jetzt nicht ändern",
  },
};

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: TEXTS.title,
  help: {
    en:
      "Choose a file of the list, or type its name: one that does not exist begins a new part program. Errors are " +
      "marked while you type. The program that is running cannot be stored; a program that is loaded has to be " +
      "loaded again to take the change.",
    de:
      "Eine Datei der Liste wählen oder ihren Namen eingeben: ein neuer Name beginnt ein neues Teileprogramm. " +
      "Fehler werden beim Tippen markiert. Das laufende Programm lässt sich nicht speichern; ein geladenes Programm " +
      "muss neu geladen werden, damit die Änderung wirkt.",
  },
  area: "full",
  async show({ body, head, endings, args, setTitle, beforeClose }) {
    const { createEditor } = await import("../edit/editor.js");
    if (!body.isConnected) return; // the screen was left meanwhile
    let [path, saved] = ["", ""];
    /** @type {string | null} */
    let version = null;
    const newest = latest(endings);
    const host = h("div.editor-host.grow", {});
    const findings = h("div.findings.scroll", { hidden: true });
    const state = h("span.hint.grow", { role: "status" });
    const saveKey = keyOf(TEXTS.save, () => save(), ".main");
    head.append(
      keyOf(TEXTS.open, async () => {
        if (await mayDrop()) await open(path);
      }),
      keyOf(TEXTS.new, () => begin()),
      keyOf(TEXTS.dxf, () => openScreen("load", { source: "dxf" })),
      keyOf(TEXTS.saveas, () => saveAs()),
      saveKey,
    );
    body.classList.add("is-editor");
    body.append(host, findings, h("div.row", {}, state));
    const editor = createEditor(host, {
      check: async (text) =>
        (await send("POST", "check", { text, dialect: "", path }).catch(() => ({ findings: [] }))).findings,
      found: (list) => {
        findings.hidden = list.length === 0;
        findings.replaceChildren(...findingItems(list, (each) => editor.goTo(each.line, each.column)));
      },
      changed: () => draw(),
    });
    endings.add(() => editor.close());

    const isChanged = () => editor.text() !== saved;
    const isLocked = () => Boolean(path && model.program.value.loaded?.path === path && model.state.value.running);
    function draw() {
      setTitle(`${t(TEXTS.title)}: ${path || t(TEXTS.unnamed)}${isChanged() ? " *" : ""}`);
      saveKey.disabled = isLocked() || !isChanged();
      setText(state, isLocked() ? t(TEXTS.locked) : t("edit.lines", { count: editor.lines() }));
      editor.setReadOnly(isLocked());
    }
    endings.add(model.state.watch(draw));

    async function mayDrop() {
      if (!isChanged()) return true;
      const chosen = await ask({
        title: t("edit.leave"),
        body: [h("p", {}, t("edit.leave.text", { name: path || t(TEXTS.unnamed) }))],
        choices: [
          { text: t("key.cancel"), value: "stay" },
          { text: t("form.drop"), value: "drop", kind: "danger" },
          { text: t(TEXTS.save), value: "save", kind: "main" },
        ],
      });
      return chosen === "drop" || (chosen === "save" && (await save()));
    }
    beforeClose(mayDrop);

    /**
     * Read a file; one that does not exist begins with this name.
     * @param {string} name
     */
    async function read(name) {
      try {
        const file = await newest(readFile(name));
        if (!file) return;
        [path, version, saved] = [name, file.version, file.text];
      } catch (error) {
        if (!(error instanceof ApiError) || error.status !== 404) {
          refuse(error);
          return;
        }
        [path, version, saved] = [name, null, ""];
      }
      editor.setText(saved);
      draw();
      editor.focus();
    }

    /**
     * Ask for a file by list or name.
     * @param {string} preset
     */
    async function open(preset) {
      const name = h("input.field.grow", {
        value: preset,
        ariaLabel: t("edit.name"),
        autocomplete: "off",
        spellcheck: false,
      });
      const list = fileList({
        kinds: ["program", "other", "batch"],
        chosen: (entry) => {
          name.value = entry.path;
        },
      });
      const chosen = await ask({
        title: t(TEXTS.open),
        body: [list.element, h("label.row", {}, t("edit.name"), name)],
        first: name,
        className: "wide",
        choices: [
          { text: t("key.cancel"), value: null },
          {
            text: t(TEXTS.open),
            kind: "main",
            isSubmit: true,
            value: () => withEnding(name.value.trim()) || undefined,
          },
        ],
      });
      if (chosen) await read(chosen);
    }

    async function begin() {
      if (!(await mayDrop())) return;
      void newest(Promise.resolve()); // a file that is still on its way is not shown
      [path, version, saved] = ["", null, ""];
      editor.setText("");
      draw();
      editor.focus();
    }

    async function saveAs() {
      const name = withEnding((await askText(t(TEXTS.saveas), t("edit.name"), path || "NEW.TXT")) ?? "");
      if (!name) return false;
      if (name !== path) [path, version] = [name, null];
      return save();
    }

    /** @returns {Promise<boolean>} */
    async function save() {
      if (!path) return saveAs();
      const text = editor.text();
      const written = path;
      try {
        const stored = await writeFile(written, text, version);
        report(t("edit.saved", { name: written }));
        if (path !== written) return true; // another file was opened meanwhile
        [version, saved] = [stored.version, text];
        draw();
        return true;
      } catch (error) {
        if (!(error instanceof ApiError)) throw error;
        if (error.status !== 409 && error.status !== 412) {
          refuse(error);
          return false;
        }
        const isSure = await ask({
          title: t("edit.conflict"),
          body: [h("p", {}, error.message)],
          choices: [
            { text: t("key.cancel"), value: false },
            { text: t("edit.overwrite"), kind: "danger", value: true },
          ],
        });
        if (!isSure) return false;
        version = "*";
        return save();
      }
    }

    draw();
    const { loaded } = model.program.value;
    if (args.path) void read(args.path).then(() => args.line && editor.goTo(args.line, args.column));
    else void open(!args.other && loaded?.kind === "file" ? loaded.path : "");
  },
};

/**
 * A name without an ending gets that of part programs.
 * @param {string} name
 */
function withEnding(name) {
  return !name || /\.[^./]+$/.test(name) ? name : `${name}.TXT`;
}
