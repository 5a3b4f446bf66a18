// What the scope does, from what the server and this browser know of its capture.
import { duration } from "../core/format.js";
import { t } from "../core/texts.js";

const TEXTS = {
  none: { en: "No record: START begins one", de: "Keine Aufzeichnung: START beginnt eine" },
  running: { en: "RECORDING, {time}", de: "ZEICHNET AUF, {time}" },
  rests: { en: "Record of {time}", de: "Aufzeichnung von {time}" },
};

/** @typedef {"idle" | "taken" | "stopped" | "waiting" | "triggered" | "running"} State */

/**
 * @param {import("./recording.js").Capture} capture
 * @param {{ trigger: object | null, isTaken: boolean } | null} recording of this browser; null before its first START
 * @returns {State}
 */
export function stateOf(capture, recording) {
  if (!recording) return "idle";
  if (recording.isTaken) return "taken";
  if (!capture.running) return "stopped";
  if (!recording.trigger) return "running";
  return (capture.trigger ?? null) === (capture.swept ?? null) ? "waiting" : "triggered";
}

/**
 * The state in words.
 * @param {State} state
 * @param {import("./recording.js").Capture} capture
 * @param {number} count of samples of this browser
 */
export function stateText(state, capture, count) {
  if (state === "idle") return "";
  if (state === "taken") return t("scope.state.taken", { owner: capture.owner ?? "\u2013" });
  if (state === "stopped") return t("scope.stopped", { count });
  if (state === "running") return count ? t("scope.read", { count }) : t("scope.armed");
  return t(state === "waiting" ? "scope.state.waiting" : "scope.state.triggered", { count });
}

/**
 * The state of a long record in words.
 * @param {import("./long_record.js").LongRecord} record
 */
export function recordText({ state, ends, ms }) {
  if (!state.number) return t(TEXTS.none);
  return t(state.running ? TEXTS.running : TEXTS.rests, { time: duration(((ends[1] - ends[0]) * ms) / 1000) });
}
