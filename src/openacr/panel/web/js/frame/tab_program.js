// The PROGRAM tab: the text of the loaded program with the executing line.
import { get } from "../core/api.js";
import { model } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { t } from "../core/texts.js";
import { chosenLine } from "../draw/path.js";
import { beginRun } from "../motion/begin.js";
import { createListing } from "./listing.js";

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export function programTab(panel, endings) {
  let isFollowing = true;
  const name = h("strong.grow", {}, "");
  const followKey = h("button.key", { type: "button", ariaPressed: "true", onclick: () => setFollowing(!isFollowing) }, t("program.follow"));
  const fromKey = h("button.key", { type: "button", hidden: true, onclick: () => beginRun({ dry: false, line: chosenLine.value }) }, "");
  panel.append(h("div.row.pane-tools", {}, name, fromKey, followKey));
  const listing = createListing(panel, {
    read: async (first, lines) => (await get("program/listing", { first, lines })).lines,
    clicked: (line) => chosenLine.set(line),
    scrolled: () => setFollowing(false),
    label: t("tab.program"),
  });
  /** @param {boolean} on */
  function setFollowing(on) {
    isFollowing = on;
    followKey.ariaPressed = String(on);
    if (on) listing.mark(model.status.value?.line ?? 0, true);
  }
  let [id, line] = ["", -1];
  endings.add(
    model.program.watch(({ loaded }) => {
      setText(name, loaded?.name ?? t("alarm.noprogram"));
      if ((loaded?.id ?? "") === id) return;
      id = loaded?.id ?? "";
      listing.forget();
      listing.setTotal(loaded?.lines ?? 0);
    }),
    model.status.watch((status) => {
      if (!status || status.line === line) return;
      line = status.line;
      listing.mark(line, isFollowing);
    }),
    chosenLine.watch((chosen) => {
      listing.choose(chosen);
      fromKey.hidden = chosen <= 1;
      setText(fromKey, t("program.from", { line: chosen }));
    }),
  );
}
