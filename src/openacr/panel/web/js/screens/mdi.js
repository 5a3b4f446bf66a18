// MDI: one block at a time; executed lines stay in a buffer that can be edited and saved as a program.
import { ApiError, writeFile } from "../core/api.js";
import { give, model, refuse, report } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { askText } from "../frame/dialog.js";
import { mayMove } from "../motion/actions.js";

const TEXTS = {
  buffer: { en: "Executed blocks", de: "Ausgeführte Sätze" },
  line: { en: "Block", de: "Satz" },
  on: { en: "BUFFER", de: "PUFFER" },
  keep: { en: "KEEP EDIT", de: "ÜBERNEHMEN" },
  runall: { en: "RUN ALL", de: "ALLE AUSFÜHREN" },
  save: { en: "SAVE AS", de: "SPEICHERN" },
  clear: { en: "CLEAR", de: "LEEREN" },
  running: { en: "A block is being executed", de: "Ein Satz wird ausgeführt" },
  count: { en: "{count} {count|block|blocks}", de: "{count} {count|Satz|Sätze}" },
};

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "MDI", de: "MDI" },
  mode: "mdi",
  show({ body, endings }) {
    const buffer = h("textarea.field.mono.grow", { ariaLabel: t(TEXTS.buffer), spellcheck: false, wrap: "off" });
    const line = h("input.field.mono.grow", {
      ariaLabel: t(TEXTS.line),
      placeholder: "G0 X10 Y5",
      autocomplete: "off",
      spellcheck: false,
      autocapitalize: "characters",
      autofocus: true,
    });
    const state = h("span.hint", { role: "status" });
    const isOn = h("input", { type: "checkbox", onchange: () => give("mdi.buffer", { on: isOn.checked }) });
    /** @type {string[]} */
    let history = [];
    /** @type {string[]} executed while the buffer was off */
    let unkept = [];
    let place = 0;
    let isEdited = false;
    const execute = async () => {
      const text = line.value.trim();
      if (!text || !mayMove() || (isEdited && !(await keepEdit()))) return;
      if (await give("mdi.execute", { line: text })) {
        line.value = "";
        place = 0;
        if (!model.mdi.value.on) {
          unkept.push(text);
          history.push(text);
        }
      }
      line.focus();
    };
    line.addEventListener("keydown", (event) => {
      if (event.key !== "ArrowUp" && event.key !== "ArrowDown") return;
      event.preventDefault();
      place = Math.min(history.length, Math.max(0, place + (event.key === "ArrowUp" ? 1 : -1)));
      line.value = place ? history[history.length - place] : "";
    });
    buffer.addEventListener("input", () => {
      isEdited = true;
      keep.hidden = false;
    });
    const lines = () => buffer.value.split("\n").filter((each) => each.trim());
    const keepEdit = async () => {
      const done = await give("mdi.buffer", { lines: lines() });
      isEdited = isEdited && !done;
      keep.hidden = !isEdited;
      return done;
    };
    const keep = keyOf(TEXTS.keep, keepEdit, "", { hidden: true });
    const runAll = keyOf(TEXTS.runall, async () => {
      if (mayMove() && (!isEdited || (await keepEdit()))) await give("mdi.execute", { lines: lines(), kept: true });
    });
    const save = keyOf(TEXTS.save, () => saveAs(buffer.value));
    const clear = keyOf(TEXTS.clear, async () => {
      if (await give("mdi.buffer", { lines: [] })) buffer.value = "";
    });
    body.append(
      buffer,
      h(
        "div.row.wrap",
        {},
        h("label.check.row", {}, isOn, t(TEXTS.on)),
        state,
        h("span.grow", {}),
        keep,
        runAll,
        save,
        clear,
      ),
      h(
        "form.row",
        {
          onsubmit: (/** @type {Event} */ event) => {
            event.preventDefault();
            void execute();
          },
        },
        line,
        h("button.key.main.big", { type: "submit" }, t("mdi.execute")),
      ),
    );
    endings.add(
      model.mdi.watch((mdi) => {
        isOn.checked = mdi.on;
        if (mdi.on) unkept = [];
        history = [...mdi.buffer, ...unkept];
        if (!isEdited) buffer.value = mdi.buffer.join("\n");
        buffer.scrollTop = buffer.scrollHeight;
        setText(state, mdi.running ? t(TEXTS.running) : t(TEXTS.count, { count: mdi.buffer.length }));
      }),
    );
  },
};

/** @param {string} text */
async function saveAs(text) {
  const name = await askText(t(TEXTS.save), t("edit.name"), "MDI.TXT");
  if (!name) return;
  try {
    await writeFile(name, `${text}\n`, null);
    report(t("edit.saved", { name }));
  } catch (error) {
    if (error instanceof ApiError) refuse(error);
    else throw error;
  }
}
