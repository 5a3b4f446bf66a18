// The STOP key: always there, from every screen, also over dialogs by the Pause key.
import { model } from "../core/app.js";
import { byId, h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { ACTIONS } from "../motion/actions.js";

/** @param {(menu: string) => void} [openMenu] where keys for what follows a stop are shown */
export function startStop(openMenu = () => {}) {
  const key = h(
    "button.stop-key",
    { type: "button", title: t("stop.title"), attr: { "aria-keyshortcuts": "Pause" } },
    t("menu.stop"),
    h("small", {}, t("stop.hold")),
  );
  let isPointed = false;
  // On contact, not on release: a finger that slides off has stopped the machine nevertheless.
  key.addEventListener("pointerdown", () => {
    isPointed = true;
    void ACTIONS.stop({ openMenu });
  });
  key.addEventListener("click", () => {
    if (!isPointed) void ACTIONS.stop({ openMenu });
    isPointed = false;
  });
  byId("stop").append(key);
  window.addEventListener(
    "keydown",
    (event) => {
      if (event.key !== "Pause" || event.repeat) return;
      void ACTIONS.stop({ openMenu });
      event.preventDefault();
    },
    { capture: true },
  );
  model.state.watch((state) => key.classList.toggle("is-busy", Boolean(state.busy)));
}
