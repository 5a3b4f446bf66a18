// Start of the operator's workspace: read-out and keys first, then the display window.
import { link, model } from "./core/app.js";
import { applyTheme, followSystemTheme, setting } from "./core/settings.js";
import { useLanguage } from "./core/texts.js";

async function start() {
  link.onEvent = (event) => model.takeEvent(event);
  link.onFrame = (head, data) => model.takeFrame(head, data);
  link.subscribe({ topic: "status", hz: 25 });
  link.open(); // values arrive while the modules do
  applyTheme();
  followSystemTheme();
  useLanguage(setting("language", "en"));
  const [clock, status, menuBar, top, prompt, stop, held, screens] = await Promise.all([
    import("./frame/clock.js"),
    import("./frame/status.js"),
    import("./frame/menu_bar.js"),
    import("./frame/top.js"),
    import("./frame/prompt.js"),
    import("./frame/stop.js"),
    import("./motion/hold.js"),
    import("./frame/screen_host.js"),
  ]);
  top.startTop(async (tab) => (await import("./frame/display.js")).showTab(tab));
  status.startStatus();
  prompt.startPrompt();
  screens.startScreens();
  menuBar.startMenuBar();
  stop.startStop(menuBar.openMenu);
  held.startHeldKeys();
  clock.startClock();
  const [display, splitter] = await Promise.all([import("./frame/display.js"), import("./frame/splitter.js")]);
  display.startDisplay();
  splitter.startSplitter();
}

void start();
