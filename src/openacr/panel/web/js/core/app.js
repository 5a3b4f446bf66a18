// The objects every screen works with: the connection, the model, and how commands are given.
import { CommandError, Link } from "./link.js";
import { Model } from "./model.js";
import { Signal } from "./signal.js";

const scheme = window.location.protocol === "https:" ? "wss" : "ws";
export const link = new Link(`${scheme}://${window.location.host}/ws`);
export const model = new Model();
// Values are old after `stale_ms`; a connection that stays silent twice as long is taken for dead.
model.hello.watch(({ limits }) => {
  link.silentMs = 2 * limits.stale_ms;
});

/** The line under the windows: `kind` is "say", "good", "error" or "ask". */
export const prompt = new Signal({ kind: "say", text: "" });

/**
 * Give a command; a refusal is shown in the prompt line. Returns the result, or null if refused.
 * @param {string} cmd
 * @param {Record<string, any>} [args]
 * @returns {Promise<any>}
 */
export async function give(cmd, args = {}) {
  try {
    return await link.command(cmd, args);
  } catch (error) {
    if (!(error instanceof CommandError)) throw error;
    refuse(error.message);
    return null;
  }
}

/**
 * Show why something was not done.
 * @param {unknown} reason
 */
export function refuse(reason) {
  prompt.set({ kind: "error", text: reason instanceof Error ? reason.message : String(reason) });
}

/** @param {string} text */
export function report(text) {
  prompt.set({ kind: "good", text });
}
