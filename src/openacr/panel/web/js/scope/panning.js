// A record that is at rest is zoomed by the wheel or by keys and dragged along.

/**
 * The plugin of uPlot that asks for another part of the record.
 * @param {{ isAsked: () => boolean, zoom: (isFiner: boolean, at: number) => void, pan: (by: number) => void,
 *   reset: () => void }} asked times in ms; `isAsked`: a drag pans
 */
export function panningPlugin({ isAsked, zoom, pan, reset }) {
  return {
    hooks: {
      /** @param {any} plot */
      init(plot) {
        let held = Number.NaN;
        const time = (/** @type {MouseEvent} */ event) =>
          plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x");
        plot.over.addEventListener(
          "wheel",
          (/** @type {WheelEvent} */ event) => {
            event.preventDefault();
            zoom(event.deltaY < 0, time(event));
          },
          { passive: false },
        );
        plot.over.addEventListener("dblclick", reset);
        plot.over.addEventListener("pointerdown", (/** @type {PointerEvent} */ event) => {
          if (!isAsked()) return;
          held = time(event);
          plot.over.setPointerCapture(event.pointerId);
        });
        plot.over.addEventListener("pointermove", (/** @type {PointerEvent} */ event) => {
          if (!Number.isNaN(held)) pan(held - time(event));
        });
        for (const name of ["pointerup", "pointercancel"])
          plot.over.addEventListener(name, () => {
            held = Number.NaN;
          });
      },
    },
  };
}
