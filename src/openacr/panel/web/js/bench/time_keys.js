// The keys above the timeline: time that runs, is still or goes step by step, another branch, the machine operated again.
import { give, model } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";

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
};

const SPEEDS = [0.01, 0.1, 0.5, 1, 2, 5, 10, 100, 0]; // 0: as fast as it goes
const STEPS = ["tick", "back", "line", "move"];

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
  const operate = keyOf(TEXTS.operate, () => void give("timeline.operate"));
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
      setText(pause, t(still ? TEXTS.run : TEXTS.pause));
      operate.disabled = !away;
      branch.disabled = !away || isEnd;
    },
  };
}
