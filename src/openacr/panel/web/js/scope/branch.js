// What a branch of the timeline did at the ticks of a recording: a reference for the scope.
import { get } from "../core/api.js";
import { model } from "../core/app.js";
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { ask } from "../frame/dialog.js";

export const BRANCH = { en: "BRANCH \u2026", de: "ZWEIG \u2026" };
const TEXT = {
  en: "What another branch of the timeline did at the same ticks is drawn dashed; REFERENCE takes it away.",
  de: "Was ein anderer Zweig der Zeitleiste in denselben Takten tat, wird gestrichelt gezeichnet; REFERENZ nimmt es weg.",
};

/**
 * What a branch that is chosen did at the ticks that are shown, as a reference; null where none is chosen.
 * @param {import("./recording.js").Recording} recording
 * @param {import("./channels.js").Channels} channels
 * @returns {Promise<import("./reference.js").Kept | null>}
 */
export async function ofBranch(recording, channels) {
  const { why, branch: present, branches, period_s: tickTime } = model.timeline.value;
  const others = branches.flatMap((each) =>
    each.number === present || each.last === null ? [] : { ...each, last: each.last },
  );
  if (why || !others.length) throw new Error(why || t("time.noother"));
  const chosen = await ask({
    title: t(BRANCH),
    body: [h("p", {}, t(TEXT))],
    choices: others.map((each) => ({ text: each.name, value: each })),
  });
  if (!chosen) return null;
  const { first, zero, period } = recording.window();
  const traces = channels.traces(await samplesOf(chosen, recording, tickTime), period);
  const start = (first - zero) * 1000 * period;
  return { traces, start, from: start, period };
}

/**
 * The samples of a branch at the ticks of the samples on the screen; those that it does not have are NaN.
 * @param {{ number: number, first: number, last: number }} branch
 * @param {import("./recording.js").Recording} recording
 * @param {number} tickTime s of a tick
 * @returns {Promise<Float64Array[]>}
 */
async function samplesOf(branch, recording, tickTime) {
  const { first: shown, period, channels } = recording.window();
  const length = channels[0]?.length ?? 0;
  if (recording.tick === null || !length) throw new Error(t("scope.export.none"));
  const every = Math.max(1, Math.round(period / tickTime));
  const begin = recording.tick + (shown - recording.begun) * every;
  const skipped = Math.max(0, Math.ceil((branch.first - begin) / every));
  const first = begin + skipped * every;
  const count = Math.min(length - skipped, Math.floor((branch.last - first) / every) + 1);
  if (count < 2) throw new Error(t("time.apart"));
  const found = await get("timeline/samples", {
    branch: branch.number,
    parameters: recording.names.join(";"),
    first,
    last: first + (count - 1) * every,
    count,
  });
  return found.channels.map((/** @type {number[]} */ values) => {
    const all = new Float64Array(length).fill(Number.NaN);
    all.set(values, skipped);
    return all;
  });
}
