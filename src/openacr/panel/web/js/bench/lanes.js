// The picture of the timeline: a ruler with bookmarks, branches and lanes, the moment and the selection. The keys of the
// bookmarks are below it.
import { fill, h, setText } from "../core/dom.js";
import { t } from "../core/texts.js";
import { arranged, groupOf, lastBefore, movedBy, spanAt, toggled } from "./lane_list.js";
import { paint } from "./lane_paint.js";
import { placeOf, rulerOf } from "./time_view.js";

const LABEL = 90; // pixels of a time on the ruler
const ROW = { heading: 20, lane: 20, curve: 40 }; // pixels
const DRAGGED = 5; // pixels from which on a press selects

const TEXTS = {
  filter: { en: "Filter the lanes", de: "Spuren filtern" },
  pin: {
    en: "{name}: pin or release it; Alt with \u2191 or \u2193 moves it",
    de: "{name}: anheften oder l\u00f6sen; Alt mit \u2191 oder \u2193 verschiebt",
  },
  none: { en: "Nothing happened here, or the filter hides it", de: "Hier geschah nichts, oder der Filter verbirgt es" },
  pinned: { en: "Pinned", de: "Angeheftet" },
  part: { en: "Part program", de: "Teileprogramm" },
  axes: { en: "Axes", de: "Achsen" },
  masters: { en: "Masters", de: "Master" },
  programs: { en: "Programs", de: "Programme" },
  plcs: { en: "PLCs", de: "SPS" },
  drives: { en: "Drives on", de: "Antriebe ein" },
  alarms: { en: "Motion killed", de: "Bewegung abgebrochen" },
  io: { en: "Inputs and outputs", de: "Ein- und Ausg\u00e4nge" },
  hosts: { en: "From hosts", de: "Von Hosts" },
  sent: { en: "To hosts", de: "An Hosts" },
  hold: { en: "{name} held", de: "{name} angehalten" },
  pause: { en: "{name} paused", de: "{name} in Pause" },
  span: { en: "{name}: {seconds} s from {from} s on", de: "{name}: {seconds} s ab {from} s" },
  line: { en: "{name}, line {line} {text}", de: "{name}, Zeile {line} {text}" },
};

/**
 * @typedef {import("./lane_list.js").Lane} Lane
 * @typedef {{ tick: number, kind: string, text: string }} Bookmark
 * @typedef {import("./time_view.js").Part} Part
 * @typedef {{ lanes: Lane[], other: Lane[] | null, details: import("./lane_paint.js").Details | null }} Shown
 */

/** @param {Lane} lane */
export function labelOf({ kind, name }) {
  return kind === "hold" || kind === "pause" ? t(TEXTS[kind], { name }) : name;
}

/**
 * @param {{ seek: (tick: number) => void, zoom: (isFiner: boolean, at: number) => void, pan: (by: number) => void,
 *   select: (part: Part | null) => void, seconds: (tick: number) => string,
 *   kept: import("./lane_list.js").Arrangement, keep: (kept: import("./lane_list.js").Arrangement) => void }} asked
 */
export function createLanes({ seek, zoom, pan, select, seconds, kept, keep }) {
  const [ruler, names, now] = [h("div.time-ruler", {}), h("div.time-names", {}), h("div.time-cursor", {})];
  const [canvas, chosen] = [h("canvas.time-canvas", {}), h("div.time-selection", { hidden: true })];
  const hover = h("span.hint.time-hover", {});
  const filter = h("input.field.time-filter", {
    type: "search",
    value: kept.filter ?? "",
    ariaLabel: t(TEXTS.filter),
    placeholder: t(TEXTS.filter),
    oninput: () => arrange({ filter: filter.value }),
  });
  const body = h("div.time-rows", {}, names, canvas);
  const field = h("div.time-field", { title: t("time.lanes.use") }, ruler, body, chosen, now);
  const element = h(
    "div",
    {},
    h("div.row", {}, filter, hover),
    h("div.time-lanes", { tabIndex: 0, role: "group", ariaLabel: t("time.lanes") }, field),
  );
  /** @type {Part} */
  let part = [0, 1];
  /** @type {Part | null} */
  let selected = null;
  /** @type {Shown} */
  let shown = { lanes: [], other: null, details: null };
  /** @type {import("./lane_paint.js").Strip[]} */
  let strips = [];
  let pointed = Number.NaN; // the tick that the pointer is at

  const left = (/** @type {number} */ tick) => `${placeOf(tick, part)}%`;
  const isShown = (/** @type {number} */ tick) => tick >= part[0] && tick <= part[1];

  /** @param {MouseEvent} event */
  function tickAt(event) {
    const box = ruler.getBoundingClientRect();
    const tick = Math.round(part[0] + ((event.clientX - box.left) / box.width) * (part[1] - part[0]));
    return Math.max(part[0], Math.min(part[1], tick));
  }

  /** @param {import("./lane_list.js").Arrangement} changed */
  function arrange(changed) {
    Object.assign(kept, changed);
    keep(kept);
    list();
  }

  function list() {
    const rows = arranged(shown.lanes, kept, labelOf);
    strips = [];
    let top = 0;
    fill(
      names,
      ...rows.map((row) => {
        if ("group" in row) {
          top += ROW.heading;
          return h(
            "button.time-group",
            {
              type: "button",
              data: { name: row.group },
              ariaExpanded: String(!row.isFolded),
              style: `height: ${ROW.heading}px`,
              onclick: () => arrange({ folded: toggled(kept.folded ?? [], row.group) }),
            },
            `${row.isFolded ? "\u25b8" : "\u25be"} ${t(/** @type {any} */ (TEXTS)[row.group])} (${row.count})`,
          );
        }
        const { lane } = row;
        const hasCurve = lane.kind === "axis" && shown.details?.axes.some((each) => lane.id === `axis ${each.number}`);
        const height = hasCurve && !shown.other ? ROW.curve : ROW.lane;
        const other = shown.other?.find((each) => each.id === lane.id);
        strips.push({ lane, top, height, other });
        top += height;
        return nameOf(lane, height, Boolean(hasCurve));
      }),
    );
    if (!rows.length) names.append(h("p.hint", {}, t(TEXTS.none)));
    canvas.style.height = `${Math.max(top, ROW.lane)}px`;
    redraw();
  }

  /** @param {Lane} lane @param {number} height @param {boolean} hasCurve */
  function nameOf(lane, height, hasCurve) {
    const label = labelOf(lane);
    const isPinned = (kept.pinned ?? []).includes(lane.id);
    return h(
      "button.time-name",
      {
        type: "button",
        style: `height: ${height}px`,
        data: { lane: lane.id, name: lane.id, spans: String(lane.spans.length) },
        ariaPressed: String(isPinned),
        title: t(TEXTS.pin, { name: lane.card ? `${label} (${lane.card})` : label }),
        onclick: () => arrange({ pinned: toggled(kept.pinned ?? [], lane.id) }),
        onkeydown: (/** @type {KeyboardEvent} */ event) => {
          if (!event.altKey || !event.key.startsWith("Arrow")) return;
          event.preventDefault();
          event.stopPropagation();
          move(lane, isPinned, event.key === "ArrowUp" ? -1 : 1);
        },
      },
      h("span", {}, label),
      hasCurve ? h("span.hint", {}, t("time.lanes.unit")) : null,
    );
  }

  /** @param {Lane} lane @param {boolean} isPinned @param {number} by */
  function move(lane, isPinned, by) {
    if (isPinned) return arrange({ pinned: movedBy(kept.pinned ?? [], lane.id, by) });
    const group = groupOf(lane.kind);
    const own = strips.map((each) => each.lane).filter((each) => groupOf(each.kind) === group);
    const ids = own.map((each) => each.id).filter((id) => !(kept.pinned ?? []).includes(id));
    const others = (kept.order ?? []).filter((id) => !ids.includes(id));
    arrange({ order: [...others, ...movedBy(ids, lane.id, by)] });
  }

  function redraw() {
    paint(canvas, part, strips, { isCompared: shown.other !== null, details: shown.details });
  }

  /** @param {Part | null} next */
  function choose(next) {
    selected = next;
    chosen.hidden = !next;
    if (!next) return;
    const [from, to] = [Math.max(next[0], part[0]), Math.min(next[1], part[1])];
    chosen.hidden = to < from;
    chosen.style.left = left(from);
    chosen.style.width = `${placeOf(to, part) - placeOf(from, part)}%`;
  }

  /** @param {MouseEvent} event */
  function tell(event) {
    const y = event.clientY - canvas.getBoundingClientRect().top;
    const strip = strips.find((each) => y >= each.top && y < each.top + each.height);
    const tick = tickAt(event);
    const span = strip && spanAt(strip.lane.spans, tick);
    if (!strip || !span) return setText(hover, `${seconds(tick)} s`);
    const name = labelOf(strip.lane);
    const lines = shown.details?.programs.find((each) => strip.lane.id === `program ${each.number}`);
    const slice = lines && lastBefore(lines.slices, tick);
    const period = { from: seconds(span[0]), seconds: seconds(span[1] - span[0]) };
    setText(
      hover,
      slice
        ? t(TEXTS.line, { name, line: String(slice[1]), text: lines.texts[slice[1]] ?? "" })
        : t(TEXTS.span, { name, ...period }),
    );
  }

  element.addEventListener(
    "wheel",
    (event) => {
      if (!(event.target instanceof Node) || !field.contains(event.target)) return;
      event.preventDefault();
      if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY))
        pan(Math.sign(event.deltaX || event.deltaY) * 0.1 * (part[1] - part[0]));
      else zoom(event.deltaY < 0, tickAt(event));
    },
    { passive: false },
  );
  field.addEventListener("pointermove", (event) => {
    pointed = tickAt(event);
    tell(event);
  });
  field.addEventListener("pointerleave", () => (pointed = Number.NaN));
  field.addEventListener("pointerdown", (event) => {
    const target = event.target instanceof HTMLElement ? event.target : null;
    if (event.button !== 0 || target?.closest("button")) return;
    const [begin, x, mark] = [tickAt(event), event.clientX, target?.dataset.tick];
    let isDragged = false;
    const drag = (/** @type {PointerEvent} */ next) => {
      isDragged ||= Math.abs(next.clientX - x) >= DRAGGED;
      const at = tickAt(next);
      if (isDragged) choose(at < begin ? [at, begin] : [begin, at]);
    };
    const end = (/** @type {PointerEvent} */ next) => {
      removeEventListener("pointermove", drag);
      removeEventListener("pointerup", end);
      removeEventListener("pointercancel", end);
      if (next.type === "pointercancel") return;
      if (isDragged) select(selected);
      else seek(mark === undefined ? begin : Number(mark));
    };
    addEventListener("pointermove", drag);
    addEventListener("pointerup", end);
    addEventListener("pointercancel", end);
  });
  const sizes = new ResizeObserver(redraw);
  sizes.observe(canvas);

  return {
    element,
    /** Where the pointer is; not a number where it is not over the lanes. */
    pointed: () => pointed,
    end: () => sizes.disconnect(),
    choose,
    /** @param {Shown} next */
    show(next) {
      shown = next;
      list();
    },
    /** @param {import("./lane_paint.js").Details} details of the part that is shown */
    detail(details) {
      shown = { ...shown, details };
      list();
    },
    /**
     * @param {Part} next
     * @param {number} period s of a tick
     * @param {Bookmark[]} bookmarks
     */
    draw(next, period, bookmarks) {
      part = next;
      const times = rulerOf(part, period, Math.max(2, ruler.clientWidth / LABEL));
      fill(
        ruler,
        ...times.map((time) => h("span.time-time", { style: `left: ${left(time / period)}` }, String(time))),
        ...bookmarks
          .filter(({ tick }) => isShown(tick))
          .flatMap(({ tick, kind, text }) => [
            h("span.time-tick", {
              style: `left: ${left(tick)}`,
              data: { tick: String(tick), kind },
              title: `${seconds(tick)} s ${text}`,
              ariaHidden: "true",
            }),
            h(
              "span.time-flag",
              { style: `left: ${left(tick)}`, data: { tick: String(tick) }, ariaHidden: "true" },
              text,
            ),
          ]),
      );
      choose(selected);
      redraw();
    },
    /** @param {number} tick */
    mark(tick) {
      now.hidden = !isShown(tick);
      now.style.left = left(tick);
    },
  };
}
