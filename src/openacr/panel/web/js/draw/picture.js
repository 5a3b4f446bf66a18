// A picture of a tool path: ground, path and chosen line on three canvases, the tool as an element.
import { onTheme } from "../core/theme.js";
import { h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { Camera } from "./camera.js";
import { PENS } from "./colors.js";
import { listenToGestures } from "./gestures.js";
import { KIND, areaOf, strokesOf } from "./path.js";
import { painterFor } from "./renderer.js";
import { stockBox, stockPainter } from "./stock.js";
import { lineAt, paintChosen, paintGround } from "./underlay.js";

const NAMES = ["rapid", "cut", "grid", "limit", "blank", "stock", "dip", "below", "text"];
const NOWHERE = [0, 0, 0];
const EMPTY = [0, 0, 0, 100, 100, 10];
const CROSS = "M0 -14V14M-14 0H14M-6 0A6 6 0 1 0 6 0A6 6 0 1 0 -6 0";

/**
 * @typedef {object} Picture
 * @property {(path: import("./path.js").ToolPath | null) => void} setPath shown from the next painting on; fitted, if
 *   its extents are others
 * @property {(n: number) => void} cutTo up to this point the path is cut
 * @property {(x: number, y: number, z: number) => void} setTool
 * @property {(limits: number[] | null) => void} setLimits
 * @property {(stock: import("./stock.js").Stock | null) => void} setStock shown instead of the path
 * @property {(line: number) => void} choose
 * @property {(flip: { x: number, y: number, exchange: boolean }) => void} setFlip
 */

/**
 * @param {HTMLElement} host
 * @param {import("../core/signal.js").Endings} endings
 * @param {{ clicked?: (line: number) => void, hasTool?: boolean, more?: HTMLElement[] }} [options] `more`: keys of the
 *   user of the picture
 * @returns {Promise<Picture>}
 */
export async function createPicture(host, endings, { clicked = () => {}, hasTool = false, more = [] } = {}) {
  const [ground, material, strokes, over] = ["ground", "material", "strokes", "over"].map((layer) =>
    h("canvas", { ariaHidden: "true", data: { layer } }),
  );
  const tool = toolCursor();
  tool.style.display = hasTool ? "" : "none";
  const keys = h("div.view-keys", { role: "group", ariaLabel: t("graphics.views") });
  const area = h("div.picture", { role: "img", ariaLabel: t("graphics.label") }, ground, material, strokes, over);
  host.append(h("div.picture-frame", {}, area, keys));
  area.append(tool);
  const painter = await painterFor(strokes);
  const solid = stockPainter(material);
  const camera = new Camera();
  /** @type {import("./path.js").ToolPath | null} */
  let path = null;
  /** @type {number[] | null} */
  let limits = null;
  /** @type {import("./stock.js").Stock | null} */
  let stock = null;
  let [view, cut, painted, chosen, asked, hasMoved] = ["top", 0, 0, 0, false, false];
  let place = [0, 0, 0];
  let { colors, pens } = readColors(area);

  const contexts = () =>
    [ground, over].map((each) => {
      const pen = /** @type {CanvasRenderingContext2D} */ (each.getContext("2d"));
      const ratio = each.width / Math.max(1, camera.width);
      pen.setTransform(ratio, 0, 0, ratio, 0, 0);
      return pen;
    });
  /** @type {import("./path.js").Style[]} */
  let styles = [];
  const looks = () => styles.map(({ kind, color }) => lookOf(kind, pens[color], colors.rapid));

  function paint(isMoving = false) {
    asked = false;
    if (!isMoving) ({ colors, pens } = readColors(area)); // of the theme at this painting
    const [under, top] = contexts();
    paintGround(under, camera, colors, { limits, blank: path?.blank ?? null, zero: path?.zero ?? NOWHERE });
    if (stock) solid.paint(camera, colors, isMoving);
    else painter.paint(camera, looks(), isMoving);
    painted = 0;
    if (!isMoving) paintCut();
    top.clearRect(0, 0, camera.width, camera.height);
    if (path && chosen) paintChosen(top, camera, colors.limit, path, chosen);
    moveTool();
  }

  function paintCut() {
    if (cut > painted && !stock) painter.paintCut(painted, cut, colors.cut);
    painted = cut;
  }

  function moveTool() {
    const [x, y] = camera.project(place[0], place[1], place[2]);
    tool.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
  }

  const repaint = (isMoving = false) => {
    hasMoved = isMoving;
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => paint(hasMoved));
  };

  /** What FIT shows: the stock, the path with its blank, else the limits of the machine. */
  const extents = () => (path && areaOf(path)) ?? (limits ? [...limits] : EMPTY);

  function fit() {
    camera.fit(stock ? stockBox(stock) : extents());
    repaint();
  }

  function look(/** @type {string} */ name) {
    view = name;
    camera.look(name);
    for (const key of keys.querySelectorAll("button[data-view]"))
      key.setAttribute("aria-pressed", String(/** @type {HTMLElement} */ (key).dataset.view === name));
    fit();
  }

  keys.append(
    ...["top", "front", "side", "iso"].map((name) =>
      keyOf(/** @type {any} */ (`graphics.${name}`), () => look(name), "", { data: { view: name } }),
    ),
    keyOf("graphics.fit", fit),
    h("button.key", { type: "button", ariaLabel: t("graphics.in"), onclick: () => zoom(1.4) }, "+"),
    h("button.key", { type: "button", ariaLabel: t("graphics.out"), onclick: () => zoom(1 / 1.4) }, "\u2212"),
    ...more,
  );
  const zoom = (/** @type {number} */ factor) => {
    camera.zoom(factor, camera.width / 2, camera.height / 2);
    repaint();
  };
  listenToGestures(area, { camera, moved: repaint, clicked: (x, y) => path && clicked(lineAt(camera, path, x, y)) });
  const sizes = new ResizeObserver(() => {
    const isFirst = camera.width <= 1;
    [camera.width, camera.height, camera.inset] = [area.clientWidth, area.clientHeight, keys.clientWidth];
    for (const each of [ground, material, strokes, over]) {
      each.width = Math.max(1, Math.round(camera.width * window.devicePixelRatio));
      each.height = Math.max(1, Math.round(camera.height * window.devicePixelRatio));
    }
    if (isFirst) look(view);
    else paint();
  });
  sizes.observe(area);
  const themed = onTheme(() => repaint());
  endings.add(
    () => sizes.disconnect(),
    () => painter.close(),
    themed,
  );

  return {
    setPath(next) {
      const before = extents();
      path = next;
      [cut, painted] = [0, 0];
      const found = next ? strokesOf(next) : null;
      styles = found?.styles ?? [];
      painter.setDrawing(found?.drawing ?? null);
      if (String(extents()) === String(before)) repaint();
      else fit();
    },
    cutTo(n) {
      if (n < cut) repaint(); // the program has begun anew
      cut = n;
      if (!asked && cut > painted) paintCut();
    },
    setTool(x, y, z) {
      place = [x, y, z];
      moveTool();
    },
    setLimits(box) {
      limits = box;
      repaint();
    },
    setStock(next) {
      stock = next;
      solid.setStock(next);
      material.hidden = !next;
      strokes.hidden = Boolean(next);
      repaint();
    },
    choose(line) {
      chosen = line;
      repaint();
    },
    setFlip(flip) {
      if (JSON.stringify(flip) === JSON.stringify(camera.flip)) return;
      camera.flip = flip;
      look(view);
    },
  };
}

/**
 * Rapids are thin and dotted, compensated paths dashed, with the moves that compensation inserts.
 * @param {number} kind
 * @param {string} color
 * @param {string} rapid
 * @returns {import("./flat.js").Look}
 */
function lookOf(kind, color, rapid) {
  if (kind === KIND.rapid) return { color: rapid, width: 0.8, dashes: [4, 4] };
  return { color, width: 1.25, dashes: kind === KIND.compensated || kind === KIND.inserted ? [8, 3] : [] };
}

function toolCursor() {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const stroke = document.createElementNS("http://www.w3.org/2000/svg", "path");
  stroke.setAttribute("d", CROSS);
  svg.append(stroke);
  svg.classList.add("tool-cursor");
  svg.ariaHidden = "true";
  return svg;
}

/**
 * The colours of the theme as a canvas needs them: those with names, and the pens by their index.
 * @param {HTMLElement} area
 */
function readColors(area) {
  const probe = h("span", {});
  area.append(probe);
  const resolved = (/** @type {string} */ color) => {
    probe.style.color = color;
    return getComputedStyle(probe).color;
  };
  const named = NAMES.map((name) => [name, resolved(name === "text" ? "var(--quiet)" : `var(--draw-${name})`)]);
  const pens = PENS.map(resolved);
  probe.remove();
  return { colors: Object.fromEntries(named), pens };
}
