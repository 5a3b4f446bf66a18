// Values beside the lines of a program while it runs or is held: parameters and flags as in the watch list, variables of
// the program asked for one answer after the other.
import { get } from "../../core/api.js";
import { model } from "../../core/app.js";
import { needWords, stateOf, wordsOf } from "../../core/flags.js";
import { keyOf } from "../../core/keys.js";
import { keepSetting, setting } from "../../core/settings.js";
import { Endings } from "../../core/signal.js";
import { t } from "../../core/texts.js";
import { needValues } from "../../core/values.js";
import { numberText } from "../../frame/card_value.js";
import { parted, saidOf } from "./line_texts.js";

const TEXTS = {
  values: { en: "VALUES", de: "WERTE" },
  about: {
    en: "Values at the end of each line while its program runs or is held",
    de: "Werte am Ende jeder Zeile, solange ihr Programm l\u00e4uft oder gehalten wird",
  },
};
const KEPT = "bench.line-values";
const [EVERY_MS, REFUSED_MS, DRAW_MS] = [200, 2000, 100];

/** @typedef {import("../../edit/line_values.js").Named} Named */

/**
 * @param {{ isSeen: () => boolean, state: (level: string) => string | undefined,
 *   show: (say: import("../../edit/line_values.js").Say) => void, draw: () => void }} pane `state`: of a program,
 *   undefined while it is not known; `show` draws the values, `draw` the line below the text
 */
export function valuesPart({ isSeen, state, show, draw }) {
  const live = new Endings();
  let isOn = setting(KEPT, "on") === "on";
  let isEnded = false;
  let why = ""; // variables cannot be read
  /** @type {Named[]} */
  let seen = [];
  let wanted = "";
  /** @type {Map<number, number>} */
  let parameters = new Map();
  /** Of variables, by program and name. @type {Map<string, string>} */
  let held = new Map();
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let asking;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let drawing;

  const key = keyOf(TEXTS.values, () => turn(!isOn), "", { title: t(TEXTS.about), ariaPressed: String(isOn) });

  /** @param {boolean} on */
  function turn(on) {
    isOn = on;
    key.ariaPressed = String(on);
    keepSetting(KEPT, on ? "on" : "off");
    follow();
  }

  const isLive = (/** @type {string} */ program) => !["halted", undefined].includes(state(program));
  const liveLines = () => (isOn ? seen.filter(({ program }) => isLive(program)) : []);

  /** Have the values of what is in view come, and of nothing else. */
  function follow() {
    const { numbers, flags, locals } = parted(liveLines());
    const now = JSON.stringify([numbers, flags, locals]);
    if (now !== wanted) {
      wanted = now;
      live.end();
      [parameters, held, why] = [new Map(), new Map(), ""];
      if (numbers.length)
        live.add(
          needValues(numbers, (known) => {
            parameters = known;
            soon();
          }),
        );
      if (flags.length) live.add(needWords(wordsOf(flags)));
      clearTimeout(asking);
      if (Object.keys(locals).length) void read(now, locals);
    }
    soon();
  }

  /**
   * @param {string} mine what is wanted: another question ends this one
   * @param {Record<string, string[]>} locals
   */
  async function read(mine, locals) {
    if (isSeen() && !document.hidden) {
      const before = why;
      for (const [program, names] of Object.entries(locals)) {
        const about = { program: Number(program.slice(4)), names: names.join(";") };
        const found = await get("card/values", about).catch((/** @type {Error} */ error) => error);
        if (isEnded || mine !== wanted) return;
        why = found instanceof Error ? found.message : "";
        for (const name of names) held.delete(`${program} ${name}`);
        if (!why) for (const [name, text] of Object.entries(found.values)) held.set(`${program} ${name}`, text);
      }
      if (why !== before) draw();
      soon();
    }
    asking = setTimeout(() => void read(mine, locals), why ? REFUSED_MS : EVERY_MS);
  }

  /** @type {import("./line_texts.js").ValueOf} */
  function valueOf(program, name) {
    const number = Number(/^(?:P|BIT)(\d+)$/.exec(name)?.[1] ?? Number.NaN);
    if (name.startsWith("BIT")) {
      const flag = stateOf(model.flags.value, number);
      return flag === undefined ? undefined : t(flag ? "io.on" : "io.off");
    }
    if (Number.isNaN(number)) return held.get(`${program} ${name}`);
    const value = parameters.get(number);
    return value === undefined ? undefined : numberText(value, "plain");
  }

  /** Draw at most ten times a second, whatever comes. */
  function soon() {
    drawing ??= setTimeout(() => {
      drawing = undefined;
      show((named) => (isOn && isLive(named.program) ? saidOf(named, valueOf) : null));
    }, DRAW_MS);
  }

  return {
    key,
    /** Why the variables of the program have no values; empty where they have. */
    why: () => (isOn ? why : ""),
    /** @param {Named[]} now what the lines in view name */
    seen(now) {
      seen = now;
      follow();
    },
    /** What programs do may have changed. */
    follow,
    watch() {
      const ends = model.flags.watch(soon);
      return () => {
        isEnded = true;
        ends();
        live.end();
        clearTimeout(asking);
        clearTimeout(drawing);
      };
    },
  };
}
