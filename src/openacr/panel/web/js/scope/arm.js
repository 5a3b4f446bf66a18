// A capture or a record begins; one of another browser is replaced only when that is confirmed.
import { give, link, refuse } from "../core/app.js";
import { CommandError } from "../core/link.js";
import { t } from "../core/texts.js";
import { confirm } from "../frame/dialog.js";

/**
 * Begin a capture; what the server says of it, or null.
 * @param {"scope.arm" | "scope.index" | "record.begin"} command
 * @param {Record<string, any>} args
 * @returns {Promise<any>}
 */
export async function arm(command, args) {
  const take = command === "record.begin" ? t("record.begin") : t("scope.take");
  try {
    return await link.command(command, args);
  } catch (error) {
    if (!(error instanceof CommandError)) throw error;
    if (error.code === "taken" && (await confirm(take, error.message, take)))
      return give(command, { ...args, take: true });
    refuse(error.message);
    return null;
  }
}

/**
 * Go on with a capture after each connection that was cut; returns the function that ends it. A capture that is gone
 * stays as it is: stopped.
 * @param {() => number} number of the capture, 0 before the first one
 */
export function resumed(number) {
  return link.isOpen.watch((isOpen) => {
    if (isOpen && number()) void link.command("scope.resume", { number: number() }).catch(() => {});
  });
}
