// The keys above the timeline: time that runs, is still or goes step by step, another branch, the machine operated again.
import { give, model } from "../core/app.js";
import { h } from "../core/dom.js";
import { keyOf, relabel } from "../core/keys.js";
import { t } from "../core/texts.js";
import { ask } from "../frame/dialog.js";

const TEXTS = {
  pause: { en: "PAUSE", de: "PAUSE" },
  run: { en: "RUN", de: "WEITER" },
  speed: { en: "Speed", de: "Geschwindigkeit" },
  most: { en: "as fast as it goes", de: "so schnell es geht" },
  step: { en: "STEP", de: "SCHRITT" },
  stepWhat: { en: "What a step is", de: "Was ein Schritt ist" },
  stepNumber: { en: "Number of the program or master", de: "Nummer des Programms oder Masters" },
  branch: { en: "NEW BRANCH HERE", de: "NEUER ZWEIG HIER" },
  operate: { en: "OPERATE FROM HERE", de: "VON HIER BEDIENEN" },
  blockTitle: { en: "{path} was at line {line}", de: "{path} war bei Zeile {line}" },
  block: {
    en:
      "The moves that were under way are dropped, and the part program has ended. A start at line {line} reads the lines " +
      "before it without motion, shows what differs from the state they leave, and asks before anything moves: Z goes up " +
      "first, then over the place, then down.",
    de:
      "Die laufenden Bewegungen sind verworfen, und das Teileprogramm ist beendet. Ein Start bei Zeile {line} liest die " +
      "Zeilen davor ohne Bewegung, zeigt, was sich von ihrem Ergebnis unterscheidet, und fragt, bevor sich etwas bewegt: " +
      "zuerst f\u00e4hrt Z hoch, dann \u00fcber die Stelle, dann hinunter.",
  },
  blockStart: { en: "START AT LINE {line} \u2026", de: "START BEI ZEILE {line} \u2026" },
  blockNot: { en: "NO START", de: "KEIN START" },
};

const SPEEDS = [0.01, 0.1, 0.5, 1, 2, 5, 10, 100, 0]; // 0: as fast as it goes
const STEPS = ["tick", "back", "line", "move"];

/**
 * Operate the machine from the moment on. A part program that was under way there cannot be continued, since what it had
 * read ahead is not known any more: it is offered to start it at its line, with all questions of such a start.
 */
async function operateHere() {
  const { block } = model.moment.value;
  if (!(await give("timeline.operate")) || !block) return;
  const isWanted = await ask({
    title: t(TEXTS.blockTitle, block),
    body: [h("p", {}, t(TEXTS.block, block))],
    choices: [
      { text: t(TEXTS.blockStart, block), kind: "main", value: true },
      { text: t(TEXTS.blockNot), value: null },
    ],
  });
  if (!isWanted) return;
  if (model.program.value.loaded?.path !== block.path && !(await give("program.load", { path: block.path }))) return;
  const { beginRun } = await import("../motion/begin.js");
  await beginRun({ dry: false, line: block.line });
}

/** @param {HTMLElement} head */
export function createTimeKeys(head) {
  const speed = h(
    "select.field",
    { ariaLabel: t(TEXTS.speed), onchange: () => void run() },
    ...SPEEDS.map((each) => h("option", { value: String(each) }, each ? `${each}\u00d7` : t(TEXTS.most))),
  );
  speed.value = "1";
  const run = () => give("timeline.run", { speed: Number(speed.value) || null });
  const pause = keyOf(TEXTS.pause, () => void (model.timeline.value.still ? run() : give("timeline.pause")), ".main");
  const what = h(
    "select.field",
    { ariaLabel: t(TEXTS.stepWhat), onchange: showNumber },
    ...STEPS.map((each) => h("option", { value: each }, t(/** @type {any} */ (`time.step.${each}`)))),
  );
  const number = h("input.field.time-number", {
    type: "number",
    min: "0",
    max: "15",
    value: "0",
    ariaLabel: t(TEXTS.stepNumber),
  });
  const step = () => give("timeline.step", { what: what.value, number: Number(number.value) || 0 });
  const operate = keyOf(TEXTS.operate, () => void operateHere());
  const branch = keyOf(TEXTS.branch, () => void give("timeline.branch"));
  head.append(
    pause,
    speed,
    keyOf(TEXTS.step, () => void step()),
    what,
    number,
    branch,
    operate,
  );
  function showNumber() {
    number.hidden = what.value === "tick" || what.value === "back";
  }
  showNumber();

  return {
    /** @param {{ still: boolean, away: boolean, isEnd: boolean }} now */
    show({ still, away, isEnd }) {
      relabel(pause, still ? TEXTS.run : TEXTS.pause);
      operate.disabled = !away;
      branch.disabled = !away || isEnd;
    },
  };
}
