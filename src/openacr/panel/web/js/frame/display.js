// The display window: GRAPHICS, PROGRAM, I/O STATUS, PLC and ALARMS.
import { byId } from "../core/dom.js";
import { keepSetting, setting } from "../core/settings.js";
import { t } from "../core/texts.js";
import { alarmsTab } from "./tab_alarms.js";
import { graphicsTab } from "./tab_graphics.js";
import { ioTab } from "./tab_io.js";
import { plcTab } from "./tab_plc.js";
import { programTab } from "./tab_program.js";
import { tabControl } from "./tabs.js";
import { closeScreen } from "./screen_host.js";

/** @type {(id: string) => void} */
let choose = () => {};

export function startDisplay() {
  const pane = byId("display");
  pane.ariaLabel = t("display.label");
  choose = tabControl(
    pane,
    t("display.label"),
    [
      { id: "graphics", label: t("tab.graphics"), show: graphicsTab },
      { id: "program", label: t("tab.program"), show: programTab },
      { id: "io", label: t("tab.io"), show: ioTab },
      { id: "plc", label: t("tab.plc"), show: plcTab },
      { id: "alarms", label: t("tab.alarms"), show: alarmsTab },
    ],
    (id) => keepSetting("tab", id),
  );
  choose(setting("tab", "graphics"));
}

/**
 * Show a tab of the display window, closing the screen over it.
 * @param {string} id
 */
export async function showTab(id) {
  await closeScreen();
  choose(id);
}
