// What a branch of the timeline did at the ticks of a recording: a reference for the scope.
import { get } from "../core/api.js";
import { t } from "../core/texts.js";

/**
 * The samples of a branch at the ticks of the samples on the screen; those that it does not have are NaN.
 * @param {{ number: number, first: number, last: number }} branch
 * @param {import("./recording.js").Recording} recording
 * @param {number} tickTime s of a tick
 * @returns {Promise<Float64Array[]>}
 */
export async function samplesOf(branch, recording, tickTime) {
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
