// Two cursors over the screen of the scope: they are dragged, or set as times.

/**
 * @typedef {import("../core/signal.js").Signal<[number, number] | null>} Cursors times in ms, null while they are off
 */

/**
 * The plugin of uPlot that draws cursors and has them dragged.
 * @param {Cursors} cursors
 */
export function cursorPlugin(cursors) {
  return {
    hooks: {
      /** @param {any} plot */
      init(plot) {
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
