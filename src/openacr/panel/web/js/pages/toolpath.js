// The page of `openacr mill plot x.html`: a tool path to turn, to zoom and to step through.
import { h } from "../core/dom.js";
import { Camera } from "../draw/camera.js";
import { listenToGestures } from "../draw/gestures.js";
import { painterFor } from "../draw/renderer.js";

const NEAR_PX = 12;
const ROOM = 0.85;
const STEPS = 400; // of a whole play
const PLAY_MS = 40;
const WIDER = 1.25; // lines on the page, compared with those of a picture
const DENSE = 0.7; // and where they are shaded by height

/** @type {any} */
const path = JSON.parse(document.getElementById("data")?.textContent ?? "{}");
const bytes = (/** @type {string} */ text) => Uint8Array.from(atob(text), (each) => each.charCodeAt(0)).buffer;
const points = new Float32Array(bytes(path.points));
const styles = new Uint16Array(bytes(path.style));
const lines = new Int32Array(bytes(path.lines));
const contours = path.contours.map((/** @type {string} */ text) => new Float32Array(bytes(text)));
const count = styles.length;
const byId = (/** @type {string} */ id) => /** @type {any} */ (document.getElementById(id));
const [stage, upto, play] = [byId("stage"), byId("upto"), byId("play")];
const shown = path.looks.map(() => true);
let contourShown = true;
let hovered = -1;

const layers = ["ground", "strokes", "over"].map((layer) => h("canvas", { data: { layer } }));
stage.append(...layers);
const camera = new Camera();
// Axes of the machine along the directions of the screen, and which of them are flipped.
const along = [0, 1, 2].map((direction) => path.view.findIndex((/** @type {number[]} */ row) => row[direction] !== 0));
const flipped = path.view.map((/** @type {number[]} */ row) => row.some((value) => value < 0));
camera.flip = { x: flipped[0] ? -1 : 1, y: flipped[1] ? -1 : 1, exchange: along[0] === 1 };
const box = [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity];
points.forEach((value, n) => {
  box[n % 3] = Math.min(box[n % 3], value);
  box[3 + (n % 3)] = Math.max(box[3 + (n % 3)], value);
});

/** Strokes of one style and height each, so that each of them is one stroke of the pen. */
function strokesOf() {
  /** @type {number[][]} */
  const spans = path.looks.flatMap(() => Array.from({ length: path.bands }, () => []));
  let [lowest, highest] = [Infinity, -Infinity];
  const height = (/** @type {number} */ n) => points[3 * n + 2] + points[3 * n + 5];
  for (let n = 0; n < count; n++) {
    if (path.looks[styles[n]].label === "rapid") continue;
    lowest = Math.min(lowest, height(n));
    highest = Math.max(highest, height(n));
  }
  const place = (/** @type {number} */ n) => {
    const band = Math.floor(((height(n) - lowest) / (highest - lowest || 1)) * path.bands);
    return styles[n] * path.bands + (path.bands === 1 ? 0 : Math.max(0, Math.min(path.bands - 1, band)));
  };
  for (let n = 0; n < count;) {
    const [first, at] = [n, place(n)];
    while (n < count && place(n) === at) n++;
    spans[at].push(first, n);
  }
  return spans.map((each) => Uint32Array.from(each));
}

/** A colour made darker in the depth, lighter in the height. @param {string} color @param {number} band */
function shade(color, band) {
  if (path.bands === 1) return color;
  const share = (2 * band) / (path.bands - 1) - 1;
  const part = (/** @type {number} */ at) => {
    const value = parseInt(color.slice(at, at + 2), 16);
    return Math.round(value + 0.65 * Math.abs(share) * ((share > 0 ? 255 : 0) - value));
  };
  return `rgb(${part(1)}, ${part(3)}, ${part(5)})`;
}

const looks = () =>
  path.looks.flatMap((/** @type {any} */ look, /** @type {number} */ n) =>
    Array.from({ length: path.bands }, (_each, band) => ({
      color: shade(look.color, band),
      width: look.width * (path.bands > 1 ? DENSE : WIDER),
      dashes: look.dashes.map((/** @type {number} */ dash) => dash * look.width),
      isHidden: !shown[n],
    })),
  );
const place = (/** @type {number} */ n) => camera.project(points[3 * n], points[3 * n + 1], points[3 * n + 2]);
const pens = [layers[0], layers[2]].map(
  (each) => /** @type {CanvasRenderingContext2D} */ (/** @type {HTMLCanvasElement} */ (each).getContext("2d")),
);
const painter = await painterFor(/** @type {HTMLCanvasElement} */ (layers[1]));
painter.setDrawing({ points, strokes: strokesOf() });

/** The extents: a box whose edges carry their axis, from and to. @param {CanvasRenderingContext2D} pen */
function paintExtents(pen) {
  const corner = (/** @type {number} */ bits) => {
    const at = [0, 0, 0];
    along.forEach(
      (axis, direction) =>
        (at[axis] = (((bits >> direction) & 1) === 1) !== flipped[axis] ? path.high[axis] : path.low[axis]),
    );
    return camera.project(at[0], at[1], at[2]);
  };
  pen.strokeStyle = "#bbb";
  pen.lineWidth = 0.8;
  pen.beginPath();
  for (let one = 0; one < 8; one++) {
    for (const bit of [1, 2, 4]) {
      if (one & bit) continue;
      pen.moveTo(...corner(one));
      pen.lineTo(...corner(one | bit));
    }
  }
  pen.stroke();
  pen.fillStyle = "#666";
  pen.font = "12px system-ui, sans-serif";
  for (const [from, direction] of [
    [0, 0],
    [1, 1],
    [0, 2],
  ]) {
    const axis = along[direction];
    const [[x0, y0], [x1, y1]] = [corner(from), corner(from | (1 << direction))];
    if (path.high[axis] - path.low[axis] < 1e-9 || Math.hypot(x1 - x0, y1 - y0) < 40) continue;
    pen.textAlign = direction === 1 ? "left" : "right";
    pen.textBaseline = direction === 2 ? "middle" : "top";
    const short = (/** @type {number} */ value) => String(Number(value.toPrecision(5)));
    pen.fillText(
      `${path.names[axis]}  ${short(path.low[axis])} \u2026 ${short(path.high[axis])} ${path.unit}`,
      (x0 + x1) / 2 + (direction === 1 ? 8 : -8),
      (y0 + y1) / 2 + 6,
    );
  }
}

/** Contours that the path was compensated from. @param {CanvasRenderingContext2D} pen */
function paintContours(pen) {
  if (!contourShown) return;
  pen.strokeStyle = path.contourColor;
  pen.lineWidth = 0.9;
  for (const contour of contours) {
    pen.beginPath();
    for (let n = 0, isUp = true; n < contour.length; n += 3) {
      if (Number.isNaN(contour[n])) isUp = true;
      else {
        pen[isUp ? "moveTo" : "lineTo"](...camera.project(contour[n], contour[n + 1], contour[n + 2]));
        isUp = false;
      }
    }
    pen.stroke();
  }
}

/** Start, end and the point under the mouse. @param {CanvasRenderingContext2D} pen */
function paintMarks(pen) {
  const ring = (/** @type {number} */ n, /** @type {number} */ radius) => {
    pen.beginPath();
    pen.arc(...place(n), radius, 0, 7);
    pen.stroke();
  };
  pen.strokeStyle = pen.fillStyle = "#000";
  pen.lineWidth = 1.5;
  ring(0, 6);
  const [x, y] = place(Number(upto.value));
  pen.fillRect(x - 4, y - 4, 8, 8);
  if (hovered >= 0) ring(hovered, 5);
}

function paintOver() {
  pens[1].clearRect(0, 0, camera.width, camera.height);
  paintMarks(pens[1]);
  const n = hovered >= 0 ? hovered : Number(upto.value);
  const at = path.names
    .map((/** @type {string} */ name, /** @type {number} */ axis) =>
      name.trim() ? `${name}${points[3 * n + axis].toFixed(path.digits[axis])}` : "",
    )
    .join(" ");
  byId("where").textContent =
    n > 0 ? `line ${lines[n - 1]}: ${at} (${path.looks[styles[n - 1]].label})` : `start: ${at}`;
}

let isAsked = false;
let isMoving = false;
function repaint(moving = false) {
  isMoving = moving;
  if (isAsked) return;
  isAsked = true;
  requestAnimationFrame(() => {
    isAsked = false;
    pens[0].clearRect(0, 0, camera.width, camera.height);
    paintExtents(pens[0]);
    paintContours(pens[0]);
    const last = Number(upto.value);
    painter.paint(camera, looks(), isMoving, last < count ? last : Infinity);
    paintOver();
  });
}

/** The end of the move that is nearest to a place, -1 for none. @param {number} x @param {number} y */
function nearest(x, y) {
  let [best, least] = [-1, NEAR_PX * NEAR_PX];
  for (let n = 1; n <= Number(upto.value); n++) {
    if (!shown[styles[n - 1]]) continue;
    const [px, py] = place(n);
    const away = (px - x) ** 2 + (py - y) ** 2;
    if (away < least) [best, least] = [n, away];
  }
  return best;
}

/** All of it, with room for the sizes. */
function whole() {
  camera.fit(box);
  camera.zoom(ROOM, camera.width / 2, camera.height / 2);
  repaint();
}

function face(/** @type {string} */ name) {
  camera.look(name);
  whole();
}

/** @param {any} style @param {(isOn: boolean) => void} change */
function key({ label, color, dashes }, change) {
  const tick = h("input", { type: "checkbox", checked: true, onchange: () => (change(tick.checked), repaint()) });
  const sample = h("canvas", { width: 36, height: 10 });
  const pen = /** @type {CanvasRenderingContext2D} */ (sample.getContext("2d"));
  pen.strokeStyle = color;
  pen.lineWidth = 2;
  pen.setLineDash(dashes.map((/** @type {number} */ dash) => dash * 1.2));
  pen.beginPath();
  pen.moveTo(2, 5);
  pen.lineTo(34, 5);
  pen.stroke();
  byId("keys").append(h("label", {}, tick, sample, ` ${label}`));
}

path.looks.forEach((/** @type {any} */ each, /** @type {number} */ n) => key(each, (isOn) => (shown[n] = isOn)));
if (contours.length)
  key({ label: "programmed contour", color: path.contourColor, dashes: [] }, (isOn) => (contourShown = isOn));
for (const button of document.querySelectorAll("button[data-view]"))
  button.addEventListener("click", () => face(/** @type {HTMLElement} */ (button).dataset.view ?? "iso"));
byId("title").textContent = path.title;
const note = byId("note");
note.textContent = path.hasErrors
  ? "the program has errors"
  : "drag to turn, shift-drag to move, wheel to zoom, double-click for all";
if (path.hasErrors) note.className = "error";
upto.max = count;
upto.value = count;
upto.addEventListener("input", () => repaint());
listenToGestures(stage, { camera, moved: repaint, clicked: () => {} });
stage.addEventListener("pointermove", (/** @type {PointerEvent} */ event) => {
  if (event.buttons) return;
  const area = stage.getBoundingClientRect();
  const found = nearest(event.clientX - area.left, event.clientY - area.top);
  if (found === hovered) return;
  hovered = found;
  paintOver();
});
stage.addEventListener("dblclick", whole);

/** @type {ReturnType<typeof setInterval> | undefined} */
let playing;
function stop() {
  clearInterval(playing);
  playing = undefined;
  play.textContent = "play";
}
play.addEventListener("click", () => {
  if (playing) {
    stop();
    return;
  }
  if (Number(upto.value) >= count) upto.value = 0;
  play.textContent = "stop";
  playing = setInterval(() => {
    upto.value = Math.min(count, Number(upto.value) + Math.max(1, Math.round(count / STEPS)));
    repaint();
    if (Number(upto.value) >= count) stop();
  }, PLAY_MS);
});
new ResizeObserver(() => {
  const isFirst = camera.width <= 1;
  [camera.width, camera.height] = [stage.clientWidth, stage.clientHeight];
  for (const each of layers) {
    each.width = Math.max(1, Math.round(camera.width * devicePixelRatio));
    each.height = Math.max(1, Math.round(camera.height * devicePixelRatio));
  }
  for (const pen of pens) pen.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
  if (isFirst) face("iso");
  else repaint();
}).observe(stage);
