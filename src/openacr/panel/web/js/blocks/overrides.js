// Feed, rapid and spindle override: the feed override is always at hand.
import { give, model } from "../core/app.js";
import { h, setText } from "../core/dom.js";
import { plain } from "../core/format.js";
import { t } from "../core/texts.js";
import { openScreen } from "../frame/screen_host.js";

const LAST_CLICK = 15;
/** @type {{ which: "feed" | "rapid" | "spindle", value: "fov" | "rov" | "sov" }[]} */
const SWITCHES = [
  { which: "feed", value: "fov" },
  { which: "rapid", value: "rov" },
  { which: "spindle", value: "sov" },
];

/**
 * One click more or less; nothing at either end.
 * @param {"feed" | "rapid" | "spindle"} which
 * @param {1 | -1} step
 */
function stepOverride(which, step) {
  const click = (model.overrides.value[which]?.click ?? 0) + step;
  if (click >= 0 && click <= LAST_CLICK) void give("override.choose", { which, click });
}

/** @param {HTMLElement} strip */
export function overrideStrip(strip) {
  const percents = SWITCHES.map(({ which, value }) => ({ which, value, text: h("strong.live", {}, "\u2013") }));
  const show = (/** @type {typeof percents[number]} */ { which, text }) =>
    h(
      "button.key.percent",
      { type: "button", onclick: () => openScreen("overrides"), title: t("override.open") },
      h("small", {}, t(`override.${which}`)),
      text,
    );
  const stepKey = (/** @type {1 | -1} */ step) =>
    h(
      "button.key.step",
      {
        type: "button",
        ariaLabel: t(step > 0 ? "override.more" : "override.less"),
        onclick: () => stepOverride("feed", step),
      },
      step > 0 ? "+" : "\u2212",
    );
  strip.setAttribute("role", "group");
  strip.ariaLabel = t("override.label");
  strip.append(stepKey(-1), show(percents[0]), stepKey(1), show(percents[1]), show(percents[2]));
  model.status.watch(
    (status) => status && percents.forEach(({ value, text }) => setText(text, `${plain(status[value])} %`)),
  );
  return strip;
}
