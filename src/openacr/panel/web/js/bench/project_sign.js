// The sign in the bar that the card differs from its project; a press opens the pane Project.
import { get, latest } from "../core/api.js";
import { model } from "../core/app.js";
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { openPane } from "./workspace.js";

const TEXTS = {
  differs: { en: "\u2260 PROJECT", de: "\u2260 PROJEKT" },
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
  const read = () => {
    if (kind !== "project") key.hidden = true;
    else
      void newest(get("project"))
        .then((found) => {
          if (!found) return;
          key.hidden = !found.differs.length;
          key.title = t(TEXTS.names, { names: found.differs.join(", ") });
        })
        .catch(() => {}); // the card is out of reach: the sign stays as it was
  };
  model.texts.watch(read);
  model.hello.watch(({ machine }) => {
    if (machine.kind === kind) return;
    ({ kind } = machine);
    read();
  });
  return key;
}
