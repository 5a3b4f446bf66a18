// Names of parameters and flags anywhere in the workspace: dragged into a pane, or with a menu of their own. An element
// with `data-item="P12288"` has one, and so has a number in a text.
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { want } from "./wanted.js";

const TEXTS = {
  watch: { en: "watch", de: "beobachten" },
  scope: { en: "scope", de: "Scope" },
  compare: { en: "compare", de: "vergleichen" },
  values: { en: "show in Values", de: "in Werte zeigen" },
  used: { en: "where used", de: "wo verwendet" },
};

const FAR = 6; // pixels from which a pressed name is dragged
const ID = /^(P|BIT)\s*\d+$/i;
/** Panes that take a name. @type {import("./wanted.js").Taker[]} */
const TAKERS = ["watch", "scope", "timeline", "tree"];

/**
 * What can be done with a parameter or flag, by the keys of the search.
 * @param {string} id P12288 or BIT516
 * @returns {import("./palette_entries.js").Act[]}
 */
export function actsOn(id) {
  return [
    { label: TEXTS.watch, keys: "Enter", does: () => want("watch", id) },
    { label: TEXTS.scope, keys: "Ctrl+Enter", does: () => want("scope", id) },
    { label: TEXTS.compare, keys: "Shift+Enter", does: () => want("timeline", id) },
    { label: TEXTS.values, keys: "Alt+Enter", does: () => want("tree", id) },
    {
      label: TEXTS.used,
      keys: "Ctrl+Shift+Enter",
      does: async () => (await import("./palette.js")).openPalette(`:${id}`),
    },
  ];
}

/** Names can be dragged, and have a menu by the right button, Shift+F10 or the menu key. */
export function startNames() {
  window.addEventListener("pointerdown", pressed);
  window.addEventListener("contextmenu", (event) => {
    const id = itemAt(event) || numberAt(event);
    if (!id) return;
    event.preventDefault();
    showMenu(id, event);
  });
}

/** The name that an element under the pointer or with the focus has; empty where it has none. @param {Event} event */
function itemAt(event) {
  const target = event.composedPath()[0];
  if (!(target instanceof Element) || target.closest("dialog")) return "";
  const named = target.closest("[data-item]");
  if (named) return named.getAttribute("data-item") ?? "";
  const active = target.getAttribute("aria-activedescendant");
  return (active && document.getElementById(active)?.dataset.item) || "";
}

/** The number in a text at the pointer: P12288, BIT 516; empty where there is none. @param {MouseEvent} event */
function numberAt(event) {
  const target = event.composedPath()[0];
  if (!(target instanceof Element) || target.closest("dialog, input, textarea")) return "";
  const root = target.getRootNode();
  const shadowRoots = root instanceof ShadowRoot ? [root] : [];
  const at = /** @type {any} */ (document).caretPositionFromPoint?.(event.clientX, event.clientY, { shadowRoots });
  const hint = target.closest(".cm-hint");
  const line = hint ? hint.previousSibling?.textContent : at?.offsetNode.textContent;
  return wordAt(line ?? "", hint ? (line ?? "").length : (at?.offset ?? 0));
}

/**
 * The parameter or flag that is written at a place of a text.
 * @param {string} text
 * @param {number} place
 */
export function wordAt(text, place) {
  for (const { 0: word, index } of text.matchAll(/\b(?:P|BIT\s*)\d+/gi))
    if (index <= place && place <= index + word.length) return word.replace(/\s+/g, "").toUpperCase();
  return "";
}

// --- dragging -------------------------------------------------------------------------

/** @param {PointerEvent} event */
function pressed(event) {
  const target = event.composedPath()[0];
  const id = event.button === 0 && event.pointerType === "mouse" ? itemAt(event) : "";
  if (!ID.test(id) || (target instanceof Element && target.closest("input, select, textarea"))) return;
  const from = [event.clientX, event.clientY];
  const ghost = h("div.name-ghost", {}, id);
  const ends = new AbortController();
  const options = { signal: ends.signal, capture: true };
  const isDragged = () => ghost.isConnected;

  const end = () => {
    ends.abort();
    ghost.remove();
    document.body.classList.remove("is-naming");
  };
  /** @param {PointerEvent} move */
  const moved = (move) => {
    if (!isDragged()) {
      if (Math.hypot(move.clientX - from[0], move.clientY - from[1]) < FAR) return;
      window.getSelection()?.removeAllRanges();
      document.body.classList.add("is-naming");
      document.body.append(ghost);
    }
    ghost.style.transform = `translate(${move.clientX + 12}px, ${move.clientY + 12}px)`;
    ghost.classList.toggle("is-taken", takerAt(move) !== null);
  };
  window.addEventListener("pointermove", moved, options);
  window.addEventListener(
    "pointerup",
    (up) => {
      const taker = isDragged() ? takerAt(up) : null;
      if (isDragged()) window.addEventListener("click", swallow, { capture: true, once: true });
      setTimeout(() => window.removeEventListener("click", swallow, { capture: true }));
      end();
      if (taker) want(taker, id);
    },
    options,
  );
  window.addEventListener("pointercancel", end, options);
  window.addEventListener("blur", (blur) => blur.target === window && end(), options);
  window.addEventListener("keydown", (key) => key.key === "Escape" && isDragged() && (swallow(key), end()), options);
}

/** @param {Event} event */
function swallow(event) {
  event.preventDefault();
  event.stopPropagation();
}

/** The pane, or the pane of the tab, that would take what is dropped. @param {PointerEvent} event */
function takerAt({ clientX, clientY }) {
  const under = document.elementFromPoint(clientX, clientY);
  const pane = under?.closest("[data-pane]")?.getAttribute("data-pane");
  const tab = under?.closest(".dv-tab")?.querySelector("[data-tab]")?.getAttribute("data-tab");
  return TAKERS.find((each) => each === (pane ?? tab)) ?? null;
}

// --- the menu -------------------------------------------------------------------------

/**
 * @param {string} id
 * @param {MouseEvent} event
 */
function showMenu(id, event) {
  const before = document.activeElement;
  const ends = new AbortController();
  const close = () => {
    ends.abort();
    menu.remove();
    if (before instanceof HTMLElement || before instanceof SVGElement) before.focus();
  };
  const items = actsOn(id).map(({ label, does }) =>
    h(
      "button.key.item",
      {
        type: "button",
        role: "menuitem",
        tabIndex: -1,
        onclick: () => {
          close();
          void does();
        },
      },
      t(label),
    ),
  );
  const menu = h(
    "div.name-menu.list",
    { role: "menu", ariaLabel: id, onkeydown: press },
    h("strong.name-menu-head", { ariaHidden: "true" }, id),
    ...items,
  );

  /** @param {KeyboardEvent} key */
  function press(key) {
    const at = items.findIndex((each) => each === document.activeElement);
    const places = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: -1 };
    const place = places[/** @type {keyof typeof places} */ (key.key)];
    if (place !== undefined) items.at(place % items.length)?.focus();
    else if (key.key === "Escape" || key.key === "Tab") close();
    else return;
    swallow(key);
  }

  document.body.append(menu);
  const { width, height } = menu.getBoundingClientRect();
  menu.style.left = `${Math.max(0, Math.min(event.clientX, window.innerWidth - width))}px`;
  menu.style.top = `${Math.max(0, Math.min(event.clientY, window.innerHeight - height))}px`;
  items[0].focus();
  const options = { signal: ends.signal, capture: true };
  window.addEventListener(
    "pointerdown",
    (down) => !menu.contains(/** @type {Node} */ (down.target)) && close(),
    options,
  );
  window.addEventListener("blur", (blur) => blur.target === window && close(), options);
}
