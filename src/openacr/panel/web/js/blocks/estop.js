// The emergency stop circuit as the machine reports it.
import { model } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { t } from "../core/texts.js";

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export function estopBlock(panel, endings) {
  const [sign, text] = [h("strong", { ariaHidden: "true" }), h("span", {})];
  const box = h(
    "section.block.estop",
    { ariaLabel: t("block.estop"), title: t("estop.software") },
    h("div.row", {}, sign, text),
  );
  panel.append(box);
  endings.add(
    model.state.watch(({ estop }) => {
      setText(sign, estop?.on || estop?.alarm ? "\u26a0" : estop?.wired ? "\u2713" : "?");
      setText(
        text,
        estop?.on ? t("estop.on") : estop?.alarm ? t("estop.left") : estop?.wired ? t("estop.off") : t("estop.none"),
      );
      box.classList.toggle("is-on", Boolean(estop?.on || estop?.alarm));
    }),
  );
}
