// Where screens are opened and closed. A screen is a module of screens/ loaded when it is first shown.
import { link, model, prompt, refuse } from "../core/app.js";
import { byId, fill, h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { Endings, Signal } from "../core/signal.js";
import { t } from "../core/texts.js";

/**
 * @typedef {object} Place what a screen gets
 * @property {HTMLElement} body
 * @property {HTMLElement} head for keys beside the title
 * @property {Endings} endings ended when the screen closes
 * @property {any} args
 * @property {(title: string) => void} setTitle
 * @property {(ask: () => boolean | Promise<boolean>) => void} beforeClose asked before the screen is left
 *
 * @typedef {object} Screen
 * @property {import("../core/texts.js").Said} title
 * @property {import("../core/texts.js").Text} [help] its page of HELP, paragraphs with an empty line between them; else
 *   the server has one
 * @property {"side" | "full"} [area] beside the read-out (as long as nothing is given) or over it
 * @property {string} [mode] of the machine while it is shown
 * @property {(place: Place) => void | Promise<void>} show
 */

/** The name of the shown screen; empty for none. */
export const shown = new Signal("");
const endings = new Endings();
/** @type {() => boolean | Promise<boolean>} */
let mayLeave = () => true;
/** @type {Element | null} */
let cameFrom = null;
let turn = 0; // counts what was asked for: a screen, or none
let showing = 0; // the turn of the shown screen

/**
 * @param {string} name
 * @param {any} [args]
 */
export async function openScreen(name, args = {}) {
  const own = ++turn;
  if (shown.value && !(await mayLeave())) return;
  /** @type {{ screen: Screen }} */
  let module;
  try {
    module = await import(`../screens/${name}.js`);
  } catch (error) {
    refuse(error);
    return;
  }
  if (own !== turn) return; // what was asked for later counts, whatever is loaded first
  showing = own;
  endings.end();
  mayLeave = () => true;
  cameFrom = shown.value ? cameFrom : document.activeElement;
  const { screen } = module;
  const [title, keys] = [h("h2", { id: "screen-title" }, t(screen.title)), h("div.row", {})];
  const close = keyOf("key.close", () => closeScreen(), "", { data: { close: "" } });
  const body = h("div.screen-body", { tabIndex: 0 }); // where it scrolls, the keyboard scrolls it
  const pane = byId("screen");
  pane.dataset.area = screen.area ?? "side";
  pane.dataset.screen = name;
  pane.setAttribute("aria-labelledby", "screen-title");
  fill(pane, h("div.screen-head", {}, title, keys, close), body);
  pane.hidden = false;
  tellMode(screen.mode ?? "auto");
  prompt.set({ kind: "say", text: "" });
  shown.set(name);
  try {
    await screen.show({
      body,
      head: keys,
      endings,
      args,
      setTitle: (text) => fill(title, text),
      beforeClose: (question) => {
        if (own === showing) mayLeave = question;
      },
    });
  } catch (error) {
    refuse(error);
  }
  const first =
    body.querySelector("[autofocus]") ??
    body.querySelector("button:not(:disabled), input, select, textarea, [tabindex='0']");
  if (own === showing && !pane.contains(document.activeElement)) /** @type {HTMLElement} */ (first ?? close).focus();
}

/** Leave the shown screen, unless it has unsaved changes that are to be kept. */
export async function closeScreen() {
  turn += 1;
  if (!shown.value || !(await mayLeave())) return;
  endings.end();
  showing = 0;
  mayLeave = () => true;
  const pane = byId("screen");
  pane.hidden = true;
  pane.replaceChildren();
  shown.set("");
  tellMode("auto");
  if (cameFrom instanceof HTMLElement && cameFrom.isConnected) cameFrom.focus();
  else byId("menu").querySelector("button")?.focus();
}

/** Whether the read-out can be seen beside the shown screen. */
export function isReadOutVisible() {
  const box = byId("status");
  return getComputedStyle(box).visibility === "visible";
}

let mode = "auto";
/** @param {string} next */
function tellMode(next) {
  if (next === mode) return;
  mode = next;
  if (model.may("operate")) void link.command("mode", { mode }).catch(() => {});
}

export function startScreens() {
  model.hello.watch(({ client }) => {
    // The machine learns the mode from each new connection.
    if (client && mode !== "auto" && model.may("operate")) void link.command("mode", { mode }).catch(() => {});
  });
  window.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && shown.value && !document.querySelector("dialog[open]") && !event.defaultPrevented)
      void closeScreen();
  });
}
