// The bar of ten function keys: one listener for F1..F10, also over editor and terminal.
import { model, refuse } from "../core/app.js";
import { byId, fill, h, setAttributes } from "../core/dom.js";
import { Signal } from "../core/signal.js";
import { t } from "../core/texts.js";
import { ACTIONS } from "../motion/actions.js";
import { logIn } from "./log_in.js";
import { MENUS } from "./menus.js";
import { closeScreen, openScreen } from "./screen_host.js";

/** The shown menu. */
export const menu = new Signal("main");
/** @type {[import("./menus.js").MenuKey, HTMLButtonElement][]} */
let keys = [];

export function startMenuBar() {
  const bar = byId("menu");
  bar.ariaLabel = t("menu.label");
  menu.watch(build);
  model.hello.watch(update);
  model.state.watch((state) => {
    follow(state.state);
    update();
  });
  let bits = -1;
  model.status.watch((status) => {
    if (status && status.bits !== bits) update();
    bits = status?.bits ?? -1;
  });
  window.addEventListener("keydown", pressed, { capture: true });
  window.addEventListener("click", (event) => {
    const to = event.target instanceof Element ? event.target.closest("[data-menu]") : null;
    if (to instanceof HTMLElement && to.dataset.menu) openMenu(to.dataset.menu);
  });
}

/**
 * @param {string} name
 * @param {string} [from] the menu that has to be shown still: none was chosen while an answer was waited for
 */
export function openMenu(name, from) {
  if (from && menu.value !== from) return;
  closeScreen();
  menu.set(name);
}

/** A held program offers ABORT and RESUME; a program that goes on, the keys of RUN PROG. */
let before = "IDLE";
function follow(/** @type {string} */ state) {
  if (state === "PAUSED" && before !== "PAUSED" && menu.value !== "stop") menu.set("stop");
  else if (state !== "PAUSED" && before === "PAUSED" && menu.value === "stop") menu.set("run");
  before = state;
}

/** Build the keys of the shown menu; afterwards they only change their looks under the finger. */
function build() {
  const bar = byId("menu");
  const hadFocus = bar.contains(document.activeElement);
  bar.dataset.shown = menu.value;
  keys = [];
  fill(
    bar,
    ...Array.from({ length: 10 }, (_each, n) => {
      const entry = MENUS[menu.value].find((each) => each.key === n + 1);
      if (!entry) return h("span.menu-key.empty", { ariaHidden: "true" });
      const key = h(
        "button.menu-key",
        {
          type: "button",
          className: `menu-key ${entry.style ?? ""}`,
          onclick: () => press(entry),
          data: { fkey: `F${entry.key}` },
          attr: { "aria-keyshortcuts": `F${entry.key}` },
        },
        h("small", {}, `F${entry.key}`),
        h("span", {}, t(entry.label)),
      );
      keys.push([entry, key]);
      return key;
    }),
  );
  update();
  if (hadFocus) keys[0]?.[1].focus();
}

function update() {
  for (const [entry, key] of keys) {
    const reason = barred(entry);
    const role = entry.role && !model.may(entry.role) ? entry.role : null;
    key.title = role ? t("role.needed", { role: t(/** @type {any} */ (`role.${role}`)) }) : reason;
    setAttributes(key, {
      "aria-disabled": reason ? "true" : null,
      "data-locked": role,
      "aria-pressed": entry.pressed ? String(model.is(/** @type {any} */ (entry.pressed))) : null,
    });
  }
}

/**
 * Why a key has no effect now; empty if it has.
 * @param {import("./menus.js").MenuKey} entry
 */
function barred(entry) {
  return (entry.can && model.state.value.can?.[entry.can]) || "";
}

/** @param {import("./menus.js").MenuKey} entry */
async function press(entry) {
  if (entry.role && !model.may(entry.role) && !(await logIn(entry.role))) return;
  const reason = barred(entry);
  if (reason) refuse(reason);
  else if (entry.menu) openMenu(entry.menu);
  else if (entry.screen) openScreen(entry.screen, entry.args);
  else if (entry.action) void ACTIONS[entry.action]({ openMenu });
}

/** @param {KeyboardEvent} event */
function pressed(event) {
  const found = /^F([1-9]|10)$/.exec(event.key);
  if (!found || event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
  event.preventDefault();
  event.stopPropagation();
  if (event.repeat || document.querySelector("dialog[open]")) return;
  const entry = MENUS[menu.value].find((key) => key.key === Number(found[1]));
  if (entry) void press(entry);
}
