// The trigger on the screen: a line at time 0, and its level, which is dragged by its handle at the left edge.

const REACH = 22; // pixels around the handle
const HANDLE = 9;

/**
 * @typedef {{ level: number, color: string }} Mark level in divisions
 */

/**
 * The plugin of uPlot that draws the trigger and has its level dragged.
 * @param {() => Mark | null} mark
 * @param {(level: number, isDone: boolean) => void} move called while the level is dragged, in divisions
 */
export function triggerPlugin(mark, move) {
  return {
    hooks: {
      /** @param {any} plot */
      init(plot) {
        let isHeld = false;
        const place = (/** @type {PointerEvent} */ event) => {
          const box = plot.over.getBoundingClientRect();
          return { x: event.clientX - box.left, y: event.clientY - box.top };
        };
        const level = (/** @type {PointerEvent} */ event) => plot.posToVal(place(event).y, "y");
        plot.over.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => {
          const shown = mark();
          const { x, y } = place(event);
          if (!shown || x > REACH || Math.abs(y - plot.valToPos(shown.level, "y")) > REACH) return;
          isHeld = true;
          plot.over.setPointerCapture(event.pointerId);
          event.stopImmediatePropagation();
        });
        plot.over.addEventListener("pointermove", (/** @type {PointerEvent} */ event) => {
          if (!isHeld) return;
          event.stopImmediatePropagation();
          move(level(event), false);
        });
        for (const name of ["pointerup", "pointercancel"]) {
          plot.over.addEventListener(name, (/** @type {PointerEvent} */ event) => {
            if (isHeld) move(level(event), true);
            isHeld = false;
          });
        }
      },
      /** @param {any} plot */
      draw(plot) {
        const shown = mark();
        if (!shown) return;
        const { ctx, bbox } = plot;
        const pixel = devicePixelRatio;
        const x = plot.valToPos(0, "x", true);
        const y = Math.max(bbox.top, Math.min(bbox.top + bbox.height, plot.valToPos(shown.level, "y", true)));
        ctx.save();
        ctx.strokeStyle = ctx.fillStyle = shown.color;
        ctx.lineWidth = pixel;
        ctx.setLineDash([2 * pixel, 3 * pixel]);
        if (x >= bbox.left && x <= bbox.left + bbox.width) {
          ctx.beginPath();
          ctx.moveTo(x, bbox.top);
          ctx.lineTo(x, bbox.top + bbox.height);
          ctx.stroke();
          ctx.font = `bold ${12 * pixel}px sans-serif`;
          ctx.fillText("T", x + 3 * pixel, bbox.top + 12 * pixel);
        }
        ctx.beginPath();
        ctx.moveTo(bbox.left, y);
        ctx.lineTo(bbox.left + bbox.width, y);
        ctx.stroke();
        ctx.beginPath();
        ctx.moveTo(bbox.left, y - HANDLE * pixel);
        ctx.lineTo(bbox.left + 1.6 * HANDLE * pixel, y);
        ctx.lineTo(bbox.left, y + HANDLE * pixel);
        ctx.fill();
        ctx.restore();
      },
    },
  };
}
