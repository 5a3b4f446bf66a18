// What is on the screen of the scope: a sweep, a part of a record at rest, or one of a long record.
import { DIVISIONS } from "./scales.js";

/**
 * The part of the record that is shown: its traces, ms of the first sample and of the left edge, ms of a division.
 * @param {{ settings: import("./settings.js").Settings, long: import("./long_record.js").LongRecord,
 *   channels: import("./channels.js").Channels, recording: import("./recording.js").Recording }} scope
 * @param {import("./view.js").View | null} part of a record at rest; null: its sweep
 */
export function shownOf({ settings, long, channels, recording }, part) {
  if (settings.isRecord) {
    const { channels: curves, ...frame } = long.curves();
    const known = channels.traces(curves, frame.period);
    return { ...frame, traces: long.isEnvelope ? known.filter(({ label }) => label !== "M") : known };
  }
  const period = recording.period;
  const ms = 1000 * period;
  let shown = recording.window();
  if (part && ms) {
    const [from, to] = [part.from, part.from + DIVISIONS * part.step].map((each) => Math.round(each / ms) + shown.zero);
    const first = Math.max(recording.kept[0], from - 1);
    shown = {
      ...shown,
      first,
      channels: shown.channels.map((_each, channel) =>
        recording.part(channel, first, Math.min(recording.kept[1], to + 2)),
      ),
    };
  }
  const start = (shown.first - shown.zero) * ms;
  return {
    traces: channels.traces(shown.channels, period),
    start,
    period,
    from: part?.from ?? start,
    step: part?.step ?? settings.sweepMs,
  };
}
