// Draws the newest status once per picture, and greys the read-out when it is old.
import { link, model } from "../core/app.js";
import { byId, setText } from "../core/dom.js";
import { t } from "../core/texts.js";

const CHECK_MS = 100;

export function startClock() {
  /** @type {import("../core/frames.js").Status | null} */
  let drawn = null;
  const draw = () => {
    const status = model.status.value;
    if (status && status !== drawn) {
      drawn = status;
      judge();
      model.status.set(status);
      model.drawnTick = status.tick;
    }
    requestAnimationFrame(draw);
  };
  requestAnimationFrame(draw);
  setInterval(judge, CHECK_MS);
  link.isOpen.watch(judge);
  judge();
}

/** Compare the age of the last values with the limit; older ones are not shown as live. */
function judge() {
  if (link.isEnded) return; // the screens have been left
  const age = performance.now() - model.readAt;
  const isStale = !link.isOpen.value || age > model.hello.value.limits.stale_ms;
  const banner = byId("banner");
  if (isStale) setText(banner, link.isOpen.value ? t("stale.old") : t("stale.lost"));
  else if (model.is("linkLost")) setText(banner, t("stale.card"));
  banner.hidden = !isStale && !model.is("linkLost");
  if (isStale === model.isStale.value) return;
  document.body.classList.toggle("is-stale", isStale);
  model.isStale.set(isStale);
}
