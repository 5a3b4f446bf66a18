// The keys of the workspace: jobs, panes, layouts, the operator's screens.
import { byId, fill, h } from "../core/dom.js";
import { relabel } from "../core/keys.js";
import { t } from "../core/texts.js";
import { ACTIONS } from "./actions.js";
import { projectSign } from "./project_sign.js";
import { shownKeys, spokenKeys } from "./shown_keys.js";
import { NARROW } from "./narrow.js";
import { job } from "./workspace.js";

/** @typedef {import("./actions.js").ActionName} ActionName */

const JOB_KEYS = /** @type {const} */ (["program", "tune", "watch"]);

export function startBar() {
  const bar = byId("menu");
  bar.ariaLabel = t("bench.keys");
  fill(
    bar,
    ...["panes", "layouts", "close", "keys"].map((each) => keyOf("button.menu-key", /** @type {ActionName} */ (each))),
    projectSign(),
    h("a.menu-key", { href: "/" }, t("bench.operator")),
  );
  const jobs = JOB_KEYS.map((each) => keyOf("button.key", each));
  const group = h("div.row.jobs", { role: "group", ariaLabel: t("bench.jobs") }, ...jobs);
  const search = keyOf("button.key", "search");
  const place = () => (NARROW.matches ? byId("menu").prepend(group, search) : byId("tools").before(search, group));
  NARROW.addEventListener("change", place);
  place();
  job.watch((now) => {
    for (const key of jobs) key.ariaPressed = String(key.dataset.does === now);
  });
}

/**
 * A key that does an action of the workspace.
 * @param {"button.key" | "button.menu-key"} what
 * @param {ActionName} name
 */
function keyOf(what, name) {
  const { title, keys, does } = ACTIONS[name];
  const key = h(what, {
    type: "button",
    data: { does: name },
    title: `${t(title)} (${shownKeys(keys)})`,
    attr: { "aria-keyshortcuts": spokenKeys(keys) },
    onclick: () => void does(),
  });
  relabel(key, title);
  return key;
}
