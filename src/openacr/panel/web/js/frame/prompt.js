// The prompt line: what program and machine print, refusals, and questions to the operator.
import { give, link, model, prompt } from "../core/app.js";
import { byId, fill, h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { mayMove } from "../motion/actions.js";
import { askNumber } from "./number_pad.js";

const TEXTS = { waiting: { en: "waiting for the answer \u2026", de: "wartet auf die Antwort \u2026" } };

export function startPrompt() {
  const line = byId("prompt");
  line.ariaLabel = t("prompt.label");
  line.dataset.waiting = t(TEXTS.waiting);
  link.isLate.watch((isLate) => line.classList.toggle("is-waiting", isLate));
  const draw = () => {
    const { state, asking, tool_wanted: toolWanted, reason } = model.state.value;
    const { found, holds, moving, next } = model.stopped.value;
    const last = model.says.value.at(-1);
    const said = !last || (last.homing && state !== "HOMING") ? "" : last.text; // no step of a homing that is over
    if (moving.length) {
      const key = keyOf(next === "stop.all" ? "stopped.all" : "stopped.estop", () => give(next), ".danger");
      show("error", t("stopped.moving", { axes: moving.join(" ") }), key);
    } else if (asking) {
      const key = keyOf("ask.answer", () => answer(asking), ".main");
      const isNew = show("ask", asking.text || t("ask.value"), key);
      if (isNew && !document.activeElement?.closest("dialog, #screen, input")) key.focus(); // Enter answers
    } else if (toolWanted) {
      show(
        "ask",
        reason || t("tool.wanted"),
        keyOf("tool.changed", () => give("run.confirm"), ".main"),
      );
    } else if (holds) {
      show(
        "ask",
        t("stopped.held", { what: found.join(", ") }),
        keyOf("menu.resume", () => mayMove() && give("run.resume"), ".main"),
      );
    } else if (prompt.value.text) show(prompt.value.kind, prompt.value.text);
    else show("say", said);
  };
  /**
   * @param {string} kind
   * @param {string} text
   * @param {HTMLElement} [key]
   * @returns {boolean} whether it was not shown before
   */
  function show(kind, text, key) {
    const id = `${kind}|${text}`;
    if (line.dataset.shown === id) return false;
    line.dataset.shown = id;
    line.dataset.kind = kind;
    fill(line, h("span.text", { title: text }, kind === "error" ? `\u26a0 ${text}` : text), key);
    return true;
  }
  model.state.watch(draw);
  model.says.watch((lines) => {
    if (lines.length && prompt.value.kind !== "error") prompt.value = { kind: "say", text: "" };
    draw();
  });
  /** @type {any[]} */
  let alarms = [];
  model.alarms.watch(({ active }) => {
    const gone = alarms.filter((each) => !active.some((other) => other.code === each.code && other.text === each.text));
    alarms = active;
    const isOver = (/** @type {any} */ { code, text }) =>
      prompt.value.text.includes(text) || prompt.value.text.includes(`alarm ${code}`);
    if (prompt.value.kind === "error" && gone.some(isOver)) prompt.set({ kind: "say", text: "" });
  });
  prompt.watch(draw);
  model.stopped.watch(draw);
}

/** @param {{ text: string }} asking */
async function answer(asking) {
  const value = await askNumber({ title: asking.text || t("ask.value") });
  if (value !== null) await give("run.answer", { value });
}
