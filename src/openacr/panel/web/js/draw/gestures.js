// Mouse, wheel and fingers on a picture: pan, zoom, turn, choose.

const CLICK_PX = 6;

/**
 * @param {HTMLElement} area
 * @param {{ camera: import("./camera.js").Camera, moved: (isMoving: boolean) => void,
 *   clicked: (x: number, y: number) => void }} options
 */
export function listenToGestures(area, { camera, moved, clicked }) {
  /** @type {Map<number, { x: number, y: number }>} */
  const fingers = new Map();
  let travelled = 0;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let rest;
  const place = (/** @type {MouseEvent} */ event) => {
    const box = area.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  const isMoving = () => {
    moved(true);
    clearTimeout(rest);
    rest = setTimeout(() => moved(false), 140);
  };
  area.addEventListener("pointerdown", (event) => {
    if (event.target instanceof Element && event.target.closest("button")) return;
    area.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, place(event));
    if (fingers.size === 1) travelled = 0;
  });
  area.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const now = place(event);
    const [dx, dy] = [now.x - before.x, now.y - before.y];
    travelled += Math.hypot(dx, dy);
    if (fingers.size === 2) pinch(event.pointerId, before, now);
    else if (camera.isFlat || event.shiftKey || event.buttons > 1) camera.pan(dx, dy);
    else camera.turn(-dx / 160, dy / 160);
    fingers.set(event.pointerId, now);
    if (travelled > CLICK_PX) isMoving();
  });
  for (const name of /** @type {const} */ (["pointerup", "pointercancel"])) {
    area.addEventListener(name, (event) => {
      if (!fingers.delete(event.pointerId) || fingers.size || name === "pointercancel" || travelled > CLICK_PX) return;
      const { x, y } = place(event);
      clicked(x, y);
    });
  }
  area.addEventListener(
    "wheel",
    (event) => {
      const { x, y } = place(event);
      camera.zoom(Math.exp(-event.deltaY / 400), x, y);
      event.preventDefault();
      isMoving();
    },
    { passive: false },
  );
  area.addEventListener("contextmenu", (event) => event.preventDefault());

  /**
   * @param {number} id
   * @param {{ x: number, y: number }} before
   * @param {{ x: number, y: number }} now
   */
  function pinch(id, before, now) {
    const other = [...fingers].find(([each]) => each !== id)?.[1];
    if (!other) return;
    const [was, is] = [
      Math.hypot(before.x - other.x, before.y - other.y),
      Math.hypot(now.x - other.x, now.y - other.y),
    ];
    camera.pan((now.x - before.x) / 2, (now.y - before.y) / 2);
    if (was > 1) camera.zoom(is / was, (now.x + other.x) / 2, (now.y + other.y) / 2);
  }
}
