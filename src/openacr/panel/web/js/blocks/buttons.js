// The virtual push-button panel: up to 32 keys of the machine's builder, with lamps by flags.
import { get } from "../core/api.js";
import { give, model } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { needWords, stateOf, wordsOf } from "../core/flags.js";
import { t } from "../core/texts.js";

const FIRST = 980000;
const STRIDE = 20;

/** @typedef {{ number: number, caption: string, lamp: number, isToggle: boolean }} PushButton */

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export function buttonsBlock(panel, endings) {
  const keys = h("div.push-buttons", {});
  panel.append(h("section.block", { ariaLabel: t("block.buttons") }, h("h3", {}, t("block.buttons")), keys));
  /** @type {{ button: PushButton, key: HTMLElement }[]} */
  let shown = [];
  let endWords = () => {};
  const read = async () => {
    const buttons = await readButtons();
    shown = buttons.map((button) => ({ button, key: keyOf(button) }));
    fill(keys, ...(shown.length ? shown.map(({ key }) => key) : [h("p.hint", {}, t("buttons.none"))]));
    endWords();
    endWords = needWords(wordsOf(buttons.map(({ lamp }) => lamp).filter((lamp) => lamp >= 0)));
    light();
  };
  const light = () =>
    shown.forEach(({ button, key }) => {
      const isLit = button.lamp >= 0 && stateOf(model.flags.value, button.lamp) === true;
      key.querySelector(".lamp")?.classList.toggle("is-on", isLit);
      if (button.isToggle) key.ariaPressed = String(isLit);
    });
  void read();
  const isShown = (/** @type {number} */ cell) => cell >= FIRST && cell < FIRST + 32 * STRIDE;
  endings.add(
    () => endWords(),
    model.flags.watch(light),
    model.changed.watch(({ what, cells }) => what === "forms" && cells.some(isShown) && void read()),
  );
}

/** The buttons that have a caption; cells of each: caption, set bit, show bit, momentary or toggle. */
async function readButtons() {
  const form = await get("forms/BUTTONS").catch(() => ({ groups: [] }));
  /** @type {Map<number, any>} */
  const cells = new Map(
    form.groups
      .flatMap((/** @type {any} */ group) => group.rows)
      .map((/** @type {any} */ row) => [Number(row.number) - FIRST, row]),
  );
  return Array.from({ length: 32 }, (_each, n) => ({
    number: n,
    caption: String(cells.get(n * STRIDE)?.value ?? ""),
    lamp: Number(cells.get(n * STRIDE + 2)?.number_value ?? -1),
    isToggle: Number(cells.get(n * STRIDE + 3)?.number_value ?? 0) === 1,
  })).filter(({ caption }) => caption);
}

/** @param {PushButton} button */
function keyOf(button) {
  const key = h("button.key", { type: "button" }, h("span.lamp", { ariaHidden: "true" }), button.caption);
  const press = (/** @type {boolean} */ pressed) => give("button", { number: button.number, pressed });
  if (button.isToggle) {
    key.addEventListener("click", () => press(true));
    return key;
  }
  let isHeld = false;
  const release = () => {
    if (isHeld) void press(false);
    isHeld = false;
  };
  key.classList.add("hold");
  key.addEventListener("pointerdown", (event) => {
    key.setPointerCapture(event.pointerId);
    isHeld = true;
    void press(true);
  });
  for (const name of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) key.addEventListener(name, release);
  return key;
}
