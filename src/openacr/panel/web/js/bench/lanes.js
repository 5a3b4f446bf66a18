// The picture of the timeline: a ruler with bookmarks, lanes of axes and programs, and the moment. The keys of the
// bookmarks are below it.
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { placeOf, rulerOf } from "./time_view.js";

const LABEL = 90; // pixels of a time on the ruler

/**
 * @typedef {{ name: string, kind: string, spans: [number, number][] }} Lane
 * @typedef {{ tick: number, kind: string, text: string }} Bookmark
 * @typedef {import("./time_view.js").Part} Part
 */

/**
 * @param {{ seek: (tick: number) => void, zoom: (isFiner: boolean, at: number) => void, pan: (by: number) => void,
 *   seconds: (tick: number) => string }} asked
 */
export function createLanes({ seek, zoom, pan, seconds }) {
  const [ruler, rows, now] = [h("div.time-ruler", {}), h("div.time-rows", {}), h("div.time-cursor", {})];
  const element = h("div.time-lanes", { title: t("time.lanes.use") }, h("div.time-field", {}, ruler, rows, now));
  /** @type {Part} */
  let part = [0, 1];

  /** @param {MouseEvent} event */
  function tickAt(event) {
    const box = ruler.getBoundingClientRect();
    return Math.round(part[0] + ((event.clientX - box.left) / box.width) * (part[1] - part[0]));
  }

  element.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY))
        pan(Math.sign(event.deltaX || event.deltaY) * 0.1 * (part[1] - part[0]));
      else zoom(event.deltaY < 0, tickAt(event));
    },
    { passive: false },
  );
  element.addEventListener("click", (event) => {
    const mark = event.target instanceof HTMLElement ? event.target.dataset.tick : undefined;
    seek(mark === undefined ? Math.max(part[0], Math.min(part[1], tickAt(event))) : Number(mark));
  });

  const left = (/** @type {number} */ tick) => `${placeOf(tick, part)}%`;
  const isShown = (/** @type {number} */ tick) => tick >= part[0] && tick <= part[1];

  return {
    element,
    /**
     * @param {Part} shown
     * @param {number} period s of a tick
     * @param {Lane[]} lanes
     * @param {Bookmark[]} bookmarks
     */
    draw(shown, period, lanes, bookmarks) {
      part = shown;
      const times = rulerOf(part, period, Math.max(2, ruler.clientWidth / LABEL));
      fill(
        ruler,
        ...times.map((time) => h("span.time-time", { style: `left: ${left(time / period)}` }, String(time))),
        ...bookmarks
          .filter(({ tick }) => isShown(tick))
          .map(({ tick, kind, text }) =>
            h("span.time-tick", {
              style: `left: ${left(tick)}`,
              data: { tick: String(tick), kind },
              title: `${seconds(tick)} s ${text}`,
              ariaHidden: "true",
            }),
          ),
      );
      fill(
        rows,
        ...lanes.map(({ name, kind, spans }) =>
          h(
            "div.time-lane",
            { data: { lane: name } },
            h("span.time-name", {}, name),
            ...spans.map(([from, to]) =>
              h("span.time-span", {
                data: { kind },
                style: `left: ${left(Math.max(from, part[0]))}; width: ${placeOf(Math.min(to, part[1]), part) - placeOf(Math.max(from, part[0]), part)}%`,
              }),
            ),
          ),
        ),
      );
    },
    /** @param {number} tick */
    mark(tick) {
      now.hidden = !isShown(tick);
      now.style.left = left(tick);
    },
  };
}
