// The sign in the bar that the card differs from its project; a press opens the pane Project.
import { get, latest } from "../core/api.js";
import { model } from "../core/app.js";
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { readSetup, setupDiffers } from "./project_setup.js";
import { openPane } from "./workspace.js";

const TEXTS = {
  differs: { en: "\u2260 PROJECT", de: "\u2260 PROJEKT" },
  setup: {
    en: "set-up ({count} {count|setting|settings})",
    de: "Einrichtung ({count} {count|Einstellung|Einstellungen})",
  },
  names: { en: "Not the same on the card: {names}", de: "Auf der Karte nicht gleich: {names}" },
};

/** The key, hidden as long as card and project have the same. */
export function projectSign() {
  const key = h(
    "button.menu-key",
    { type: "button", hidden: true, onclick: () => openPane("project"), data: { does: "project" } },
    t(TEXTS.differs),
  );
  const newest = latest();
  let kind = "";
  /** @type {string[]} */
  let programs = [];
  let isAsked = false; // for the set-up; later the pane does
  const draw = () => {
    const count = setupDiffers.value;
    const names = [...programs, ...(count ? [t(TEXTS.setup, { count })] : [])];
    key.hidden = kind !== "project" || !names.length;
    key.title = t(TEXTS.names, { names: names.join(", ") });
  };
  const read = () => {
    if (kind !== "project") draw();
    else
      void newest(get("project"))
        .then((found) => {
          if (!found) return;
          programs = found.differs;
          draw();
          if (isAsked) return;
          isAsked = true;
          return readSetup(); // takes the card seconds: after all else
        })
        .catch(() => {}); // the card is out of reach: the sign stays as it was
  };
  setupDiffers.watch(draw);
  model.texts.watch(read);
  model.hello.watch(({ machine }) => {
    if (machine.kind === kind) return;
    ({ kind } = machine);
    read();
  });
  return key;
}
