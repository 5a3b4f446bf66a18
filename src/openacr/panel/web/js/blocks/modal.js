// The modal codes that are in force.
import { model } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export function modalBlock(panel, endings) {
  const codes = h("div.codes.mono", {});
  panel.append(h("section.block", { ariaLabel: t("block.modal") }, h("h3", {}, t("block.modal")), codes));
  endings.add(
    model.modals.watch((modals) => {
      const words = ["F", "S", "T", "D", "H"].map((letter) => `${letter}${modals[letter] ?? 0}`);
      fill(codes, ...[...modals.codes, ...words].map((code) => h("span", {}, code)));
    }),
  );
}
