// Start of the operator's workspace.
import { link, model } from "./core/app.js";
import { applyTheme, followSystemTheme, setting } from "./core/settings.js";
import { useLanguage } from "./core/texts.js";

async function start() {
  applyTheme();
  followSystemTheme();
  await useLanguage(setting("language", "en"));
  const [clock, display, menuBar, prompt, screens, status, stop, top, held, splitter] = await Promise.all([
    import("./frame/clock.js"), import("./frame/display.js"), import("./frame/menu_bar.js"), import("./frame/prompt.js"),
    import("./frame/screen_host.js"), import("./frame/status.js"), import("./frame/stop.js"), import("./frame/top.js"), import("./motion/hold.js"), import("./frame/splitter.js"),
  ]);
  link.onEvent = (event) => model.takeEvent(event);
  link.onFrame = (head, data) => model.takeFrame(head, data);
  link.subscribe({ topic: "status", hz: 25 });
  link.open();
  top.startTop();
  status.startStatus();
  display.startDisplay();
  splitter.startSplitter();
  prompt.startPrompt();
  screens.startScreens();
  menuBar.startMenuBar();
  stop.startStop();
  held.startHeldKeys();
  clock.startClock();
}

void start();
