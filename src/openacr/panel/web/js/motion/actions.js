// What the function keys do. Keys that move the machine ask first where the consequence is not visible.
import { give, model, refuse, report } from "../core/app.js";
import { position } from "../core/format.js";
import { forgetSettings } from "../core/settings.js";
import { t } from "../core/texts.js";
import { viewOf } from "../core/units.js";
import { confirm } from "../frame/dialog.js";
import { isReadOutVisible, openScreen } from "../frame/screen_host.js";
import { beginRun } from "./begin.js";
import { exit } from "./exit.js";

/** @typedef {{ openMenu: (name: string, from?: string) => void }} Context */

/**
 * Whether motion may be asked for: not with positions that are old.
 */
export function mayMove() {
  if (model.isStale.value) refuse(t("stale.refused"));
  return !model.isStale.value;
}

/** @type {Record<string, (context: Context) => any>} */
export const ACTIONS = {
  async stop({ openMenu }) {
    const done = await give("stop.hold");
    if (done && model.state.value.busy && !model.state.value.jogging) openMenu("stop");
  },
  async start() {
    if (!mayMove()) return;
    const { state, reason, tool_wanted: toolWanted } = model.state.value;
    if (state === "IDLE") return beginRun({ dry: false });
    const isSure =
      isReadOutVisible() || (await confirm(t("start.title"), t("start.covered", { state, reason }), t("menu.start")));
    if (isSure) await give(toolWanted && state === "WAIT" ? "run.confirm" : "run.start");
  },
  runLine: () => mayMove() && beginRun({ dry: false }),
  dryRun: () => mayMove() && beginRun({ dry: true }),
  resume: () => mayMove() && give("run.resume"),
  async abort({ openMenu }) {
    if (await give("run.abort")) openMenu("run", "stop");
  },
  traceBack: () => mayMove() && give("run.trace", { direction: -1 }),
  traceForward: () => mayMove() && give("run.trace", { direction: 1 }),
  traceStop: () => give("run.trace", { direction: 0 }),
  block: () => give("run.block", { on: !model.is("single") }),
  async clearZero() {
    if (!(await confirm(t("clrzero.title"), t("clrzero.text"), t("menu.clrzero")))) return;
    if (await give("zero.clear")) report(t("clrzero.done"));
  },
  async gotoZero() {
    if (!mayMove()) return;
    const status = model.status.value;
    const places = model.axes.map(
      (axis, n) =>
        `${axis.name} ${position((status?.work[n] ?? Number.NaN) * viewOf(axis).factor, viewOf(axis).decimals).trim()}`,
    );
    const planned = await give("zero.blocks", { axes: "" });
    if (!planned) return;
    const steps = planned.blocks
      .map((/** @type {string} */ block) => block.replace("G90 G0 ", ""))
      .join(t("gotozero.then"));
    const text = t("gotozero.text", { places: places.join("   "), steps, work: model.modals.value.work });
    if (await confirm(t("gotozero.title"), text, t("menu.gotozero"))) await give("zero.goto", { axes: "" });
  },
  exit,
  resize() {
    forgetSettings();
    window.location.reload();
  },
  overrides: () => openScreen("overrides"),
};
