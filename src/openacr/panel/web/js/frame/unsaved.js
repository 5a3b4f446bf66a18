// Changes that are not stored: kept on the screen, dropped or stored as the operator decides.
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { ask } from "./dialog.js";

/**
 * Whether a page may be left.
 * @param {number} count of changes
 * @param {() => Promise<boolean>} save
 */
export async function mayDrop(count, save) {
  if (!count) return true;
  const chosen = await ask({
    title: t("form.leave"),
    body: [h("p", {}, t("form.leave.text", { count }))],
    choices: [
      { text: t("key.cancel"), value: "stay" },
      { text: t("form.drop"), value: "drop", kind: "danger" },
      { text: t("form.save"), value: "save", kind: "main" },
    ],
  });
  return chosen === "drop" || (chosen === "save" && (await save()));
}
