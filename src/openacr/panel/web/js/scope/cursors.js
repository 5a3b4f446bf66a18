// Two cursors over the screen of the scope: they are dragged, moved by keys, or set as times.
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";

const TEXTS = {
  cursor: {
    en: "Cursor t{n}: arrow keys move it, up and down the level of the trigger",
    de: "Cursor t{n}: Pfeiltasten verschieben ihn, auf und ab den Pegel des Triggers",
  },
};

/**
 * @typedef {import("../core/signal.js").Signal<[number, number] | null>} Cursors times in ms, null while they are off
 */

/**
 * Where a key moves a cursor: by a sample, or by a pixel where that is more; with Shift by ten of them. Null for any
 * other key.
 * @param {{ key: string, shiftKey: boolean }} event
 * @param {number} time ms
 * @param {{ min: number, max: number, pixels: number, sample: number }} screen times in ms
 */
export function steppedBy({ key, shiftKey }, time, { min, max, pixels, sample }) {
  const by = /** @type {Record<string, number>} */ ({ ArrowLeft: -1, ArrowRight: 1 })[key];
  if (!by) return null;
  const step = Math.max(sample, (max - min) / Math.max(1, pixels));
  return Math.max(min, Math.min(max, Number((time + by * (shiftKey ? 10 : 1) * step).toPrecision(12))));
}

/**
 * The plugin of uPlot that draws cursors and has them dragged, or moved by keys.
 * @param {Cursors} cursors
 * @param {{ sample: () => number, textAt: (cursor: number) => string, raise: (event: KeyboardEvent) => void }} asked ms from one
 *   sample to the next, what is at a cursor in words, a key for the level of the trigger
 */
export function cursorPlugin(cursors, { sample, textAt, raise }) {
  const handles = [0, 1].map((n) =>
    h("div.scope-cursor", { tabIndex: 0, hidden: true, role: "slider", ariaLabel: t(TEXTS.cursor, { n: n + 1 }) }),
  );
  return {
    hooks: {
      /** @param {any} plot */
      init(plot) {
        plot.over.append(...handles);
        handles.forEach((each, n) =>
          each.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
            const both = cursors.value;
            const { min, max } = plot.scales.x;
            const screen = { min, max, pixels: plot.over.clientWidth, sample: sample() };
            const time = both && steppedBy(event, both[n], screen);
            if (time !== null && both) {
              cursors.set(n ? [both[0], time] : [time, both[1]]);
              event.preventDefault();
              event.stopPropagation();
            } else raise(event);
          }),
        );
        let held = -1;
        const time = (/** @type {PointerEvent} */ event) =>
          plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x");
        const move = (/** @type {PointerEvent} */ event) => {
          const both = cursors.value;
          if (both && held >= 0) cursors.set(held ? [both[0], time(event)] : [time(event), both[1]]);
        };
        plot.over.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => {
          if (!cursors.value) return;
          const [first, second] = cursors.value.map((each) => Math.abs(each - time(event)));
          held = first <= second ? 0 : 1;
          plot.over.setPointerCapture(event.pointerId);
          move(event);
        });
        plot.over.addEventListener("pointermove", move);
        for (const name of ["pointerup", "pointercancel"])
          plot.over.addEventListener(name, () => {
            held = -1;
          });
      },
      /** @param {any} plot */
      draw(plot) {
        handles.forEach((each, n) => {
          each.hidden = !cursors.value;
          if (!cursors.value) return;
          const { min, max } = plot.scales.x;
          each.style.left = `${plot.valToPos(Math.max(min, Math.min(max, cursors.value[n])), "x")}px`;
          [each.ariaValueMin, each.ariaValueMax] = [min, max].map(String);
          each.ariaValueNow = String(cursors.value[n]);
          each.ariaValueText = textAt(n);
        });
        if (!cursors.value) return;
        const { ctx, bbox } = plot;
        ctx.save();
        ctx.strokeStyle = ctx.fillStyle = getComputedStyle(plot.root).color;
        ctx.setLineDash([3 * devicePixelRatio, 3 * devicePixelRatio]);
        ctx.font = `${12 * devicePixelRatio}px sans-serif`;
        cursors.value.forEach((time, n) => {
          const x = plot.valToPos(time, "x", true);
          if (x < bbox.left || x > bbox.left + bbox.width) return;
          ctx.beginPath();
          ctx.moveTo(x, bbox.top);
          ctx.lineTo(x, bbox.top + bbox.height);
          ctx.stroke();
          ctx.fillText(`t${n + 1}`, x + 4, bbox.top + 14 * devicePixelRatio);
        });
        ctx.restore();
      },
    },
  };
}
