// The virtual push-button panel: up to 32 keys of the machine's builder.
import { get } from "../core/api.js";
import { give, model } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";

/** @typedef {{ number: number, caption: string, toggle: boolean, lit: boolean }} PushButton */

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export function buttonsBlock(panel, endings) {
  const keys = h("div.push-buttons", {});
  panel.append(h("section.block", { ariaLabel: t("block.buttons") }, h("h3", {}, t("block.buttons")), keys));
  const draw = async () => {
    /** @type {PushButton[]} */
    const buttons = await get("buttons").then((answer) => answer.buttons, () => []);
    fill(keys, ...(buttons.length ? buttons.map(keyOf) : [h("p.hint", {}, t("buttons.none"))]));
  };
  endings.add(model.changed.watch((changed) => (changed.what === "" || changed.what === "forms") && void draw()));
}

/** @param {PushButton} button */
function keyOf(button) {
  const key = h("button.key", { type: "button", ariaPressed: button.toggle ? String(button.lit) : null },
    h("span.lamp", { className: button.lit ? "lamp is-on" : "lamp" }), button.caption);
  const press = (/** @type {boolean} */ pressed) => give("button", { number: button.number, pressed });
  if (button.toggle) {
    key.addEventListener("click", () => press(!button.lit));
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
