// Shortcuts of the workspace: Alt with a key, also in the editor and the terminal.
import { openPane, showPaneAt } from "./workspace.js";

/** What the keys do, by the code of the key. @type {Record<string, () => void>} */
const DOES = {
  KeyP: () => press("#menu [data-does=panes]"),
  KeyR: () => ofPrograms("run"),
  KeyS: () => ofPrograms("step"),
  KeyE: () => openPane("editor"),
  KeyT: () => openPane("terminal"),
};

export function startShortcuts() {
  window.addEventListener(
    "keydown",
    (event) => {
      const place = /^Digit([1-9])$/.exec(event.code)?.[1];
      const does = place ? () => showPaneAt(Number(place) - 1) : DOES[event.code];
      if (
        !does ||
        !event.altKey ||
        event.ctrlKey ||
        event.metaKey ||
        event.shiftKey ||
        event.repeat ||
        document.querySelector("dialog[open]")
      )
        return;
      event.preventDefault();
      event.stopPropagation();
      does();
    },
    { capture: true },
  );
}

/**
 * Press a key of the pane of programs, which is shown first: what it acts on is seen.
 * @param {string} does
 */
function ofPrograms(does) {
  const isSeen = Boolean(document.querySelector("[data-pane=programs] .program-keys")?.checkVisibility());
  if (isSeen) press(`[data-pane=programs] [data-does=${does}]`);
  else openPane("programs");
}

/** @param {string} key */
function press(key) {
  const found = document.querySelector(key);
  if (found instanceof HTMLButtonElement && !found.disabled) found.click();
}
