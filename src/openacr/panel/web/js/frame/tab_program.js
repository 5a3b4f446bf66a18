// The PROGRAM tab: the text of the loaded program; while it runs, the executing block is marked.
import { get } from "../core/api.js";
import { model } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
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
  const [name, phase] = [h("strong.name", {}, ""), h("span.grow.quiet", { role: "status" }, "")];
  const elsewhere = h("div.active-block.mono", { role: "status", hidden: true }); // a block of an included text
  const followKey = keyOf("program.follow", () => setFollowing(!isFollowing), "", { ariaPressed: "true" });
  const fromKey = h(
    "button.key",
    { type: "button", hidden: true, onclick: () => beginRun({ dry: false, line: chosenLine.value }) },
    "",
  );
  panel.append(h("div.row.pane-tools", {}, name, phase, fromKey, followKey), elsewhere);
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
    model.program.watch(({ loaded, file, line: at, text }) => {
      setText(name, loaded?.name ?? t("alarm.noprogram"));
      elsewhere.hidden = !file || file === loaded?.name;
      setText(elsewhere, `\u25b6 ${file} ${at}  ${text}`);
      if ((loaded?.id ?? "") === id) return;
      id = loaded?.id ?? "";
      listing.forget();
      listing.setTotal(loaded?.lines ?? 0);
    }),
    model.state.watch(({ running }) => setText(phase, t(running ? "program.runs" : "program.rests"))),
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
