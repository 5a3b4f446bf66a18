// The STOP key: always there, from every screen, also over dialogs by the Pause key.
import { model } from "../core/app.js";
import { byId, h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { ACTIONS } from "../motion/actions.js";
import { openMenu } from "./menu_bar.js";

export function startStop() {
  const key = h("button.stop-key", { type: "button", title: t("stop.title"), attr: { "aria-keyshortcuts": "Pause" } },
    t("menu.stop"), h("small", {}, t("stop.hold")));
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
  model.state.watch((state) => key.classList.toggle("is-busy", Boolean(state.busy)));
}
