// The drawing of the world: canvas, names of axes and devices over it, keys of the view.
import { address, call } from "../../core/api.js";
import { refuse } from "../../core/app.js";
import { h, setText } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { t } from "../../core/texts.js";
import { Camera } from "../../draw/camera.js";
import { listenToGestures } from "../../draw/gestures.js";
import { machinePainter } from "../../draw/machine.js";

const COLOURS = Object.freeze({
  rail: "--draw-stock",
  end: "--draw-limit",
  grid: "--edge",
  on: "--good",
  off: "--quiet",
  forced: "--bad",
  edge: "--pane",
});

/**
 * @param {HTMLElement} host
 * @param {import("../../core/signal.js").Endings} endings
 * @param {import("../panes/world.js").About} about
 */
export function createDrawing(host, endings, { links, devices }) {
  const canvas = h("canvas", { ariaHidden: "true" });
  const names = links.map((link) => h("span.world-name", { data: { axis: link.name } }));
  const signs = devices.map((device) => h("span.world-name", { data: { device: device.name } }));
  const keys = h("div.view-keys", { role: "group", ariaLabel: t("graphics.views") });
  const area = h("div.picture", { role: "img", ariaLabel: t("world.label") }, canvas, ...names, ...signs);
  host.append(h("div.picture-frame", {}, area, keys));
  const painter = machinePainter(canvas, links, devices);
  const camera = new Camera();
  let colours = readColours(area);
  let [asked, view, isFitted, isShown] = [false, "iso", true, false];

  function paint() {
    asked = false;
    painter.paint(camera, colours);
    put([
      ...names.map((name, n) => ({ name, point: painter.anchor(n) })),
      ...signs.map((name, n) => ({ name, point: painter.signAnchor(n) })),
    ]);
  }

  /**
   * Put names above their points; one that would cover another is put above it.
   * @param {{ name: HTMLElement, point: [number, number, number] }[]} all
   */
  function put(all) {
    /** @type {{ left: number, top: number, wide: number }[]} */
    const taken = [];
    for (const { name, point } of all) {
      const [x, y] = camera.project(...point);
      const [wide, high] = [name.offsetWidth, name.offsetHeight];
      const place = { left: x - wide / 2, top: y - 1.2 * high, wide };
      const covers = () =>
        taken.find(
          (other) =>
            Math.abs(other.top - place.top) < high &&
            place.left < other.left + other.wide &&
            other.left < place.left + wide,
        );
      for (let other = covers(); other; other = covers()) place.top = other.top - high - 1;
      taken.push(place);
      name.style.transform = `translate(${place.left.toFixed(1)}px, ${place.top.toFixed(1)}px)`;
    }
  }

  function repaint() {
    if (asked) return;
    asked = true;
    requestAnimationFrame(paint);
  }

  function fit() {
    isFitted = true;
    camera.fitPoints(painter.corners());
    repaint();
  }

  /** @param {string} name */
  function look(name) {
    view = name;
    camera.look(name);
    for (const key of keys.querySelectorAll("button[data-view]"))
      key.setAttribute("aria-pressed", String(/** @type {HTMLElement} */ (key).dataset.view === name));
    fit();
  }

  const moved = () => {
    isFitted = false;
    repaint();
  };
  const zoom = (/** @type {number} */ factor) => {
    camera.zoom(factor, camera.width / 2, camera.height / 2);
    moved();
  };
  keys.append(
    ...["iso", "top", "front", "side"].map((name) =>
      keyOf(/** @type {any} */ (`graphics.${name}`), () => look(name), "", { data: { view: name } }),
    ),
    keyOf("graphics.fit", fit),
    h("button.key", { type: "button", ariaLabel: t("graphics.in"), onclick: () => zoom(1.4) }, "+"),
    h("button.key", { type: "button", ariaLabel: t("graphics.out"), onclick: () => zoom(1 / 1.4) }, "\u2212"),
  );
  listenToGestures(area, { camera, moved, clicked: () => {} });
  const sizes = new ResizeObserver(() => {
    const isFirst = camera.width <= 1;
    [camera.width, camera.height, camera.inset] = [area.clientWidth, area.clientHeight, keys.clientWidth];
    canvas.width = Math.max(1, Math.round(camera.width * window.devicePixelRatio));
    canvas.height = Math.max(1, Math.round(camera.height * window.devicePixelRatio));
    if (isFirst) look(view);
    else if (isFitted) fit();
    else repaint();
  });
  sizes.observe(area);
  const themed = () => {
    colours = readColours(area);
    repaint();
  };
  document.documentElement.addEventListener("theme", themed);
  endings.add(
    () => sizes.disconnect(),
    () => painter.close(),
    () => document.documentElement.removeEventListener("theme", themed),
  );
  links.forEach((link, n) => {
    if (link.file)
      void call(address("world/body", { axis: link.axis }))
        .then((answer) => answer.arrayBuffer())
        .then((data) => painter.setBody(n, data))
        .then(repaint)
        .catch(refuse);
  });

  return {
    /**
     * @param {import("../../draw/machine.js").State} state
     * @param {string[]} texts of the axes
     * @param {string[]} onSigns of the devices
     */
    show(state, texts, onSigns) {
      painter.show(state);
      if (isFitted && !(isShown && camera.shows(painter.corners()))) fit();
      isShown = true;
      names.forEach((name, n) => setText(name, texts[n]));
      signs.forEach((name, n) => setText(name, onSigns[n]));
      repaint();
    },
  };
}

/** @param {HTMLElement} area */
function readColours(area) {
  const probe = h("span", {});
  area.append(probe);
  const found = Object.entries(COLOURS).map(([name, variable]) => {
    probe.style.color = `var(${variable})`;
    return [name, getComputedStyle(probe).color];
  });
  probe.remove();
  return /** @type {import("../../draw/machine.js").Colours} */ (Object.fromEntries(found));
}
