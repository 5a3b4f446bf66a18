// JOG: a plus and a minus key per axis, slow or fast, continuous or by one of five steps.
import { give, model } from "../core/app.js";
import { get } from "../core/api.js";
import { fill, h } from "../core/dom.js";
import { Signal } from "../core/signal.js";
import { t } from "../core/texts.js";
import { mayMove } from "../motion/actions.js";
import { holdByKeyboard, makeHeld, releaseAll, releaseKeyboard } from "../motion/hold.js";

const TEXTS = {
  speed: { en: "Speed", de: "Geschwindigkeit" },
  slow: { en: "SLOW", de: "LANGSAM" },
  fast: { en: "FAST", de: "SCHNELL" },
  how: { en: "Continuous or increment", de: "Dauernd oder schrittweise" },
  continuous: { en: "CONTINUOUS", de: "DAUERND" },
  text: {
    en: "Hold a key to move. Arrow keys move X and Y, Page Up and Page Down move Z. STOP is not an emergency stop.",
    de: "Taste halten zum Fahren. Pfeiltasten fahren X und Y, Bild auf und ab fahren Z. STOP ist kein Not-Halt.",
  },
};

const PRESETS = [1, 2, 3, 4, 5];
const CROSS = ["X", "Y"];
const CROSS_WIDE = 3; // columns
/** @type {Record<string, [string, 1 | -1]>} */
const ARROWS = {
  ArrowRight: ["X", 1],
  ArrowLeft: ["X", -1],
  ArrowUp: ["Y", 1],
  ArrowDown: ["Y", -1],
  PageUp: ["Z", 1],
  PageDown: ["Z", -1],
};
const fast = new Signal(false);
const preset = new Signal(0); // 0: continuous

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "jog.title",
  mode: "manual",
  show({ body, endings }) {
    const increments = h("div.row.wrap", { role: "radiogroup", ariaLabel: t(TEXTS.how) });
    const speeds = h("div.row", { role: "radiogroup", ariaLabel: t(TEXTS.speed) });
    const keys = h("div.jog-keys", {});
    body.append(h("div.jog-choices", {}, speeds, increments), keys, h("p.hint", {}, t(TEXTS.text)));
    /** @type {Map<string, HTMLElement>} */
    const held = new Map();
    const beside = model.axes.filter(({ name }) => !CROSS.includes(name));
    const after = beside.length < model.axes.length ? CROSS_WIDE : 0;
    model.axes.forEach((axis) => {
      for (const direction of /** @type {const} */ ([-1, 1])) {
        const sign = direction > 0 ? "+" : "\u2212";
        const key = h(
          "button.key.jog-key",
          { type: "button", ariaLabel: `${axis.name} ${direction > 0 ? "plus" : "minus"}` },
          `${axis.name}${sign}`,
        );
        [key.style.gridColumn, key.style.gridRow] = placeOf(axis.name, after + beside.indexOf(axis), direction);
        held.set(`${axis.name}${direction}`, key);
        jogKey(key, axis.name, direction);
        keys.append(key);
      }
    });
    const draw = (/** @type {(number | string)[]} */ steps) => {
      const focused = [speeds, increments].find((each) => each.contains(document.activeElement));
      fill(
        speeds,
        radio(t(TEXTS.slow), !fast.value, () => choose(fast, false)),
        radio(t(TEXTS.fast), fast.value, () => choose(fast, true)),
      );
      fill(
        increments,
        radio(t(TEXTS.continuous), preset.value === 0, () => choose(preset, 0)),
        ...PRESETS.map((n) => radio(String(steps[n - 1] ?? n), preset.value === n, () => choose(preset, n))),
      );
      /** @type {HTMLElement | null | undefined} */ (focused?.querySelector("[aria-checked=true]"))?.focus();
    };
    /** @type {(number | string)[]} */
    let steps = PRESETS.map((n) => `#${n}`);
    draw(steps);
    void readSteps().then((found) => draw((steps = found ?? steps)));
    endings.add(
      fast.watch(() => draw(steps)),
      preset.watch(() => draw(steps)),
      releaseAll,
      listenToArrows(held, body),
    );
  },
};

/**
 * X and Y as a cross, every other axis as a column beside it.
 * @param {string} name
 * @param {number} n columns before that of an axis beside the cross
 * @param {1 | -1} direction
 */
function placeOf(name, n, direction) {
  if (name === "X") return [direction > 0 ? "3" : "1", "2"];
  return [name === "Y" ? "2" : String(n + 1), direction > 0 ? "1" : "3"];
}

/**
 * Another speed or another step ends what is held.
 * @template T
 * @param {Signal<T>} signal
 * @param {T} value
 */
function choose(signal, value) {
  releaseAll();
  signal.set(value);
}

/**
 * @param {HTMLButtonElement} key
 * @param {string} axis
 * @param {1 | -1} direction
 */
function jogKey(key, axis, direction) {
  makeHeld(
    key,
    () => ({ axis, direction, fast: fast.value }),
    () => preset.value === 0,
  );
  key.addEventListener("click", () => {
    if (preset.value > 0) step(axis, direction);
  });
}

/**
 * @param {string} axis
 * @param {1 | -1} direction
 */
function step(axis, direction) {
  if (mayMove())
    void give("jog.increment", { axis, direction, preset: preset.value, fast: fast.value, tick: model.drawnTick });
}

/**
 * Arrow and page keys hold the keys of X, Y and Z while no field has the focus; as a pane among others, while the focus
 * is in it.
 * @param {Map<string, HTMLElement>} keys
 * @param {HTMLElement} body
 */
function listenToArrows(keys, body) {
  const pressed = (/** @type {KeyboardEvent} */ event) => {
    const jog = ARROWS[event.key];
    const isFree = !(
      event.target instanceof Element &&
      event.target.closest("input, select, textarea, [role=tablist], [role=radiogroup]")
    );
    const isHere = !body.closest(".bench-pane") || (event.target instanceof Node && body.contains(event.target));
    const key = jog && keys.get(jog.join(""));
    if (
      !key ||
      !isFree ||
      !isHere ||
      event.ctrlKey ||
      event.altKey ||
      event.metaKey ||
      document.querySelector("dialog[open]")
    )
      return;
    event.preventDefault();
    if (event.repeat) return;
    if (preset.value > 0) step(jog[0], jog[1]);
    else holdByKeyboard(key, event.key, { axis: jog[0], direction: jog[1], fast: fast.value });
  };
  const released = (/** @type {KeyboardEvent} */ event) => releaseKeyboard(event.key);
  window.addEventListener("keydown", pressed);
  window.addEventListener("keyup", released);
  return () => {
    window.removeEventListener("keydown", pressed);
    window.removeEventListener("keyup", released);
  };
}

/**
 * @param {string} text
 * @param {boolean} isOn
 * @param {() => void} chosen
 */
function radio(text, isOn, chosen) {
  return h("button.key", { type: "button", role: "radio", ariaChecked: String(isOn), onclick: chosen }, text);
}

/** The five increments of the first axis, as the JOG tab has them. */
async function readSteps() {
  const form = await get("forms/JOG", { axis: model.axes[0]?.index ?? 0 }).catch(() => null);
  const rows = form?.groups.flatMap((/** @type {any} */ group) => group.rows) ?? [];
  const found = PRESETS.map((n) => rows.find((/** @type {any} */ row) => Number(row.number) % 1000 === 5 + n)?.value);
  return found.every((value) => value !== undefined) ? found : null;
}
