// The status window: VIEW1 to VIEW3, each a choice of blocks, and the overrides below them.
import { get } from "../core/api.js";
import { model } from "../core/app.js";
import { byId, fill, h } from "../core/dom.js";
import { keepSetting, setting } from "../core/settings.js";
import { t } from "../core/texts.js";
import { chooseUnit, chosenUnit, shownUnit } from "../core/units.js";
import { BLOCKS } from "../blocks/blocks.js";
import { overrideStrip } from "../blocks/overrides.js";
import { tabControl } from "./tabs.js";

/** @type {Record<string, string[]>} */
const DEFAULTS = {
  view1: ["position", "feeds"],
  view2: ["distance", "next", "modal"],
  view3: ["estop", "buttons", "feeds"],
};
const FIRST_VIEW = 850040; // cell of VIEW1
/** Blocks of the three views as the store of the machine has them. */
let views = DEFAULTS;

export async function startStatus() {
  const pane = byId("status");
  pane.ariaLabel = t("status.label");
  pane.ariaBusy = "true"; // until it shows the blocks that the store has
  const tabs = Object.keys(DEFAULTS).map((id, n) => ({
    id,
    label: t("status.view", { n: n + 1 }),
    show: (/** @type {HTMLElement} */ panel, /** @type {import("../core/signal.js").Endings} */ endings) => {
      panel.classList.add("blocks");
      for (const name of views[id] ?? []) BLOCKS[name]?.(panel, endings);
    },
  }));
  const choose = tabControl(pane, t("status.label"), tabs, (id) => keepSetting("view", id));
  const unitKey = h("button.key.plain.unit-key", {
    type: "button",
    title: t("units.switch"),
    onclick: () => chooseUnit(otherUnit()),
  });
  pane.append(unitKey, overrideStrip(h("div.override-strip", {})));
  const drawUnit = () => fill(unitKey, h("strong", {}, shownUnit()), h("small", {}, ` \u2192 ${otherUnit()}`));
  let names = "";
  model.hello.watch((hello) => {
    const now = JSON.stringify(hello.machine);
    if (now !== names) redraw(choose);
    names = now;
    drawUnit();
  });
  chosenUnit.watch(() => {
    drawUnit();
    redraw(choose);
  });
  model.changed.watch(
    ({ what, cells }) =>
      what === "forms" &&
      cells.some((cell) => cell >= FIRST_VIEW && cell < FIRST_VIEW + 3) &&
      loadViews().then(() => redraw(choose)),
  );
  await loadViews();
  redraw(choose);
  pane.ariaBusy = "false";
}

function otherUnit() {
  return shownUnit() === "mm" ? "inch" : "mm";
}

/** @param {(id: string) => void} choose */
function redraw(choose) {
  const id = setting("view", "view1");
  choose("");
  choose(id);
}

async function loadViews() {
  try {
    const form = await get("forms/VIEWS");
    const rows = form.groups.flatMap((/** @type {any} */ group) => group.rows);
    views = Object.fromEntries(Object.keys(DEFAULTS).map((id, n) => [id, String(rows[n].value).split(/\s+/)]));
  } catch {
    views = DEFAULTS;
  }
}
