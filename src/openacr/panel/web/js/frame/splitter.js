// The edge between status and display window: moved by a finger, the mouse or arrow keys; this browser keeps it.
import { byId, h } from "../core/dom.js";
import { keepSetting, setting } from "../core/settings.js";
import { t } from "../core/texts.js";

const LEAST = Object.freeze({ status: 300, display: 400 }); // pixels
const STEP = 0.02; // of the width, per arrow key

export function startSplitter() {
  const work = byId("work");
  const edge = h("div.splitter", {
    role: "separator",
    tabIndex: 0,
    ariaOrientation: "vertical",
    ariaLabel: t("splitter.label"),
    attr: { "aria-valuemin": 0, "aria-valuemax": 100 },
  });
  work.append(edge);
  let share = Number(setting("split", "0")); // of the width; 0: as it is at first

  const width = () => work.clientWidth;
  const apply = () => {
    if (share) work.style.setProperty("--status-width", `${Math.round(within(share) * width())}px`);
    edge.setAttribute("aria-valuenow", String(Math.round((100 * byId("status").offsetWidth) / Math.max(1, width()))));
  };
  const within = (/** @type {number} */ wanted) =>
    Math.min(1 - LEAST.display / width(), Math.max(LEAST.status / width(), wanted));
  const move = (/** @type {number} */ wanted) => {
    share = within(wanted);
    keepSetting("split", share.toFixed(4));
    apply();
  };
  edge.addEventListener("pointerdown", (event) => {
    edge.setPointerCapture(event.pointerId);
    event.preventDefault();
    edge.focus();
  });
  edge.addEventListener("pointermove", (event) => {
    if (edge.hasPointerCapture(event.pointerId)) move((event.clientX - work.getBoundingClientRect().left) / width());
  });
  edge.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -STEP, ArrowRight: STEP }[event.key];
    if (!step) return;
    event.preventDefault();
    move(byId("status").offsetWidth / width() + step);
  });
  new ResizeObserver(apply).observe(work);
}
