// The override panel: sixteen clicks for feed, rapid and spindle.
import { give, model } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";

const TEXTS = { wired: { en: "set by its switch on the panel", de: "am Schalter des Bedienpults" } };

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "override.label",
  show({ body, endings }) {
    const places = /** @type {const} */ (["feed", "rapid", "spindle"]).map((which) => ({
      which,
      host: h("div.clicks", { role: "radiogroup", ariaLabel: t(`override.${which}`) }),
      head: h("h3", {}),
    }));
    for (const { host, head } of places) body.append(h("section.stack.click-row", {}, head, host));
    let before = "";
    endings.add(
      model.overrides.watch((overrides) => {
        if (JSON.stringify(overrides) === before) return;
        before = JSON.stringify(overrides);
        for (const { which, host, head } of places) {
          const { click = 0, percent = 100, wired = false, table = [] } = overrides[which] ?? {};
          fill(head, `${t(`override.${which}`)}  ${Math.round(percent)} %${wired ? ` \u2013 ${t(TEXTS.wired)}` : ""}`);
          const isFocused = host.contains(document.activeElement);
          fill(
            host,
            ...table.map((/** @type {number} */ value, /** @type {number} */ n) =>
              h(
                "button.key",
                {
                  type: "button",
                  role: "radio",
                  ariaChecked: String(n === click),
                  autofocus: which === "feed" && n === click,
                  disabled: wired,
                  onclick: () => give("override.choose", { which, click: n }),
                },
                `${Math.round(value)}`,
              ),
            ),
          );
          if (isFocused) /** @type {HTMLElement | null} */ (host.querySelector("[aria-checked=true]"))?.focus();
        }
      }),
    );
  },
};
