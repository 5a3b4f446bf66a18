// Keys that move an axis while they are held: one press, one motion.
//
// A press starts on contact and carries the card time of the read-out that the operator sees; from
// then on it is kept alive every 50 ms. Whatever ends it (release, cancelled or lost pointer, the
// window without focus or hidden, another mode, an alarm, a lost link, old positions), it never
// comes back to life: a new motion needs a new press.
import { link, model, refuse } from "../core/app.js";
import { CommandError } from "../core/link.js";
import { t } from "../core/texts.js";
import { shown } from "../frame/screen_host.js";

/**
 * @typedef {{ axis: string, direction: 1 | -1, fast?: boolean, speed?: number }} Jog an axis of the card has a speed
 * @typedef {{ element: HTMLElement, pointer: number | null, key: string | null, id: number }} Press
 */

/** @type {Map<number, Press>} */
const presses = new Map();
let lastPress = 0;
/** @type {ReturnType<typeof setInterval> | undefined} */
let keeper;

/**
 * Make a key jog while it is held: by a pointer, or by Space or Enter with the focus on it.
 * @param {HTMLElement} element
 * @param {() => Jog} jog what it does at the moment of the press
 * @param {() => boolean} isMeant whether the key is held now, not pressed for one step
 */
export function makeHeld(element, jog, isMeant = () => true) {
  element.classList.add("hold");
  element.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || !isMeant() || heldBy(element).length) return;
    element.setPointerCapture(event.pointerId);
    element.focus({ preventScroll: true });
    begin(element, jog(), event.pointerId, null);
  });
  for (const name of /** @type {const} */ (["pointerup", "pointercancel", "lostpointercapture"])) {
    element.addEventListener(name, (event) => {
      for (const press of heldBy(element)) if (press.pointer === event.pointerId) end(press);
    });
  }
  element.addEventListener("contextmenu", (event) => event.preventDefault());
  element.addEventListener("keydown", (event) => {
    if ((event.key !== " " && event.key !== "Enter") || !isMeant()) return;
    event.preventDefault();
    if (!event.repeat && !heldBy(element).length) begin(element, jog(), null, event.key);
  });
  element.addEventListener("keyup", (event) => {
    for (const press of heldBy(element)) if (press.key === event.key) end(press);
  });
  element.addEventListener("blur", () => heldBy(element).forEach(end));
}

/**
 * Hold a key by a key of the keyboard that does not have the focus (arrow keys of the jog screen).
 * @param {HTMLElement} element
 * @param {string} code
 * @param {Jog} jog
 */
export function holdByKeyboard(element, code, jog) {
  if (!heldBy(element).length) begin(element, jog, null, code);
}

/** @param {string} code */
export function releaseKeyboard(code) {
  for (const press of presses.values()) if (press.key === code) end(press);
}

/** End every press of this browser. */
export function releaseAll() {
  for (const press of [...presses.values()]) end(press);
}

export function startHeldKeys() {
  window.addEventListener("blur", releaseAll);
  window.addEventListener("pagehide", releaseAll);
  document.addEventListener("visibilitychange", releaseAll);
  link.isOpen.watch((isOpen) => isOpen || drop());
  model.isStale.watch((isStale) => isStale && releaseAll());
  model.alarms.watch((alarms) => alarms.bars_start && releaseAll());
  shown.watch(releaseAll);
  let mode = "";
  model.state.watch((state) => {
    if (state.mode !== mode) releaseAll();
    mode = state.mode;
  });
  model.jogEnded.watch((ended) => {
    const press = ended ? presses.get(ended.press) : undefined;
    if (!ended || !press) return;
    forget(press);
    if (!["released", "stop"].includes(ended.ended)) refuse(ended.text || t("jog.ended", { reason: ended.ended }));
  });
}

/** @param {HTMLElement} element */
function heldBy(element) {
  return [...presses.values()].filter((press) => press.element === element);
}

/**
 * @param {HTMLElement} element
 * @param {Jog} jog
 * @param {number | null} pointer
 * @param {string | null} key
 */
function begin(element, jog, pointer, key) {
  if (model.isStale.value || !Number.isFinite(model.drawnTick)) {
    refuse(t("stale.refused"));
    return;
  }
  const press = { element, pointer, key, id: ++lastPress };
  presses.set(press.id, press);
  element.classList.add("is-held");
  const args = { press: press.id, ...jog, first: true, tick: model.drawnTick };
  link.command("jog.press", args).catch((error) => {
    forget(press);
    if (error instanceof CommandError) refuse(error.message);
  });
  keeper ??= setInterval(keep, model.hello.value.limits.keep_ms);
}

function keep() {
  for (const press of presses.values()) {
    if (isStillHeld(press)) link.send({ keep: press.id, tick: model.drawnTick });
    else end(press);
  }
}

/**
 * Whether a press still has its element and its pointer. The event of a lost capture comes only with
 * the next event of the pointer, so the capture itself is asked.
 * @param {Press} press
 */
function isStillHeld({ element, pointer }) {
  return element.isConnected && (pointer === null || element.hasPointerCapture(pointer));
}

/** @param {Press} press */
function end(press) {
  if (!presses.has(press.id)) return;
  forget(press);
  link.command("jog.release", { press: press.id }).catch(() => {}); // over already, or the link is lost
}

/** @param {Press} press */
function forget(press) {
  presses.delete(press.id);
  if (!heldBy(press.element).length) press.element.classList.remove("is-held");
  if (press.pointer !== null && press.element.hasPointerCapture(press.pointer))
    press.element.releasePointerCapture(press.pointer);
  if (presses.size) return;
  clearInterval(keeper);
  keeper = undefined;
}

/** The link is lost: the card stops by its own time-out, and presses of the old link are over. */
function drop() {
  for (const press of [...presses.values()]) forget(press);
}
