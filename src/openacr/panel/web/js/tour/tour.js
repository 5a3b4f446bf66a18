// The tour: one part of the screen after the other is framed and explained. It bars nothing: every key works meanwhile.
import { fill, h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { STEPS } from "./steps.js";

let end = () => {};

/** Begin at the first part; Escape, END or the last NEXT ends it. */
export function startTour() {
  end();
  const before = document.activeElement;
  const place = h("span.quiet", {});
  const text = h("p", { role: "status" });
  const back = keyOf("tour.back", () => show(at - 1));
  const next = keyOf("tour.next", () => show(at + 1), ".main");
  const box = h(
    "section.tour",
    {
      ariaLabel: t("tour.title"),
      onkeydown: (/** @type {KeyboardEvent} */ event) => {
        const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        if (!by) return;
        event.preventDefault();
        event.stopPropagation(); // the arrows jog elsewhere
        if (at + by >= 0 && at + by < STEPS.length) show(at + by);
      },
    },
    text,
    h(
      "div.row",
      {},
      place,
      h("span.grow", {}),
      back,
      next,
      keyOf("tour.end", () => end()),
    ),
  );
  /** @type {Element | null} */
  let framed = null;
  let at = 0;

  /** @param {number} step */
  function show(step) {
    if (step >= STEPS.length) return end();
    at = step;
    framed?.classList.remove("is-framed");
    framed = document.querySelector(STEPS[at][0]);
    framed?.classList.add("is-framed");
    fill(text, t(STEPS[at][1]));
    fill(place, `${at + 1} / ${STEPS.length}`);
    back.disabled = at === 0;
    (document.activeElement === back && at ? back : next).focus();
  }

  const escaped = (/** @type {KeyboardEvent} */ event) => {
    if (event.key !== "Escape" || document.querySelector("dialog[open]")) return;
    event.preventDefault();
    event.stopPropagation();
    end();
  };
  end = () => {
    end = () => {};
    window.removeEventListener("keydown", escaped, true);
    framed?.classList.remove("is-framed");
    box.remove();
    if (before instanceof HTMLElement && before.isConnected) before.focus();
  };
  window.addEventListener("keydown", escaped, true);
  document.querySelector("#work")?.append(box);
  show(0);
}
