// Start of the engineer's workspace: the frame of the operator's with panes in the place of its windows.
import { link, model } from "../core/app.js";
import { showSymbols } from "../core/keys.js";
import { applyTheme, followSystemTheme, setting } from "../core/settings.js";
import { addTexts, useLanguage } from "../core/texts.js";
import texts from "../catalog/bench.js";
import { symbolOf } from "./symbols.js";

async function start() {
  link.onEvent = (event) => model.takeEvent(event);
  link.onFrame = (head, data) => model.takeFrame(head, data);
  link.subscribe({ topic: "status", hz: 25 });
  link.open();
  applyTheme();
  followSystemTheme();
  useLanguage(setting("language", "en"));
  addTexts(texts);
  showSymbols(symbolOf);
  const [clock, top, prompt, stop, workspace, bar, actions, names, forced] = await Promise.all([
    import("../frame/clock.js"),
    import("../frame/top.js"),
    import("../frame/prompt.js"),
    import("../frame/stop.js"),
    import("./workspace.js"),
    import("./bar.js"),
    import("./actions.js"),
    import("./names.js"),
    import("./forced.js"),
  ]);
  top.startTop(() => workspace.openPane("alarms"));
  prompt.startPrompt();
  stop.startStop();
  clock.startClock();
  workspace.startWorkspace();
  bar.startBar();
  actions.startActions();
  names.startNames();
  forced.startForced();
}

void start();
