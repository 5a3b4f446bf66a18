// Strokes by WebGL: the points stay on the graphics card, only the camera changes.
import {
  BufferAttribute,
  BufferGeometry,
  LineBasicMaterial,
  LineSegments,
  Scene,
  WebGLRenderer,
} from "../../vendor/three.js";
import { thinning } from "./flat.js";
import { follow, newView } from "./view.js";

/**
 * @param {HTMLCanvasElement} canvas
 * @returns {import("./flat.js").Painter}
 */
export function solidPainter(canvas) {
  const renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
  renderer.autoClear = false;
  renderer.setPixelRatio(1); // the canvas has the pixels of the screen
  const [scene, view] = [new Scene(), newView()];
  /** @type {{ whole: LineSegments, thin: LineSegments, ends: Uint32Array }[]} */
  let strokes = [];
  /** @type {LineSegments | null} */
  let cut = null;
  const all = () => [...strokes.flatMap(({ whole, thin }) => [whole, thin]), ...(cut ? [cut] : [])];
  const dispose = () => {
    scene.clear();
    for (const each of all()) {
      each.geometry.dispose();
      /** @type {LineBasicMaterial} */ (each.material).dispose();
    }
    [strokes, cut] = [[], null];
  };

  /**
   * Lines between pairs of points.
   * @param {BufferAttribute} places
   * @param {Uint32Array} index
   */
  function add(places, index) {
    const geometry = new BufferGeometry().setAttribute("position", places).setIndex(new BufferAttribute(index, 1));
    const line = new LineSegments(geometry, new LineBasicMaterial());
    line.frustumCulled = false;
    line.visible = false;
    scene.add(line);
    return line;
  }

  return {
    setDrawing(drawing) {
      dispose();
      if (!drawing) return;
      const places = new BufferAttribute(drawing.points, 3);
      const step = thinning(drawing);
      strokes = drawing.strokes.map((spans) => {
        const index = pairs(spans, 1);
        return {
          whole: add(places, index),
          thin: add(places, step > 1 ? pairs(spans, step) : index),
          ends: index.filter((_each, n) => n % 2 === 1),
        };
      });
      cut = add(places, pairs(new Uint32Array([0, Math.max(0, drawing.points.length / 3 - 1)]), 1));
    },
    paint(camera, looks, isMoving, last = Infinity) {
      renderer.setSize(canvas.width, canvas.height, false); // no other call: each sets the canvas, too
      follow(view, camera);
      for (const each of all()) each.visible = false;
      strokes.forEach(({ whole, thin, ends }, n) => {
        const line = isMoving && last === Infinity ? thin : whole;
        line.visible = !looks[n].isHidden;
        /** @type {LineBasicMaterial} */ (line.material).color.set(looks[n].color);
        if (line === whole) line.geometry.setDrawRange(0, 2 * countUpTo(ends, last));
      });
      renderer.clear();
      renderer.render(scene, view);
    },
    paintCut(from, to, color) {
      if (!cut || to <= from) return;
      for (const each of all()) each.visible = false;
      cut.visible = true;
      /** @type {LineBasicMaterial} */ (cut.material).color.set(color);
      cut.geometry.setDrawRange(2 * from, 2 * (to - from));
      renderer.render(scene, view);
    },
    close() {
      dispose();
      renderer.dispose();
    },
  };
}

/**
 * Pairs of points that lines join, in their order.
 * @param {Uint32Array} spans
 * @param {number} step
 */
function pairs(spans, step) {
  const index = [];
  for (let k = 0; k < spans.length; k += 2) {
    for (let at = spans[k]; at < spans[k + 1]; at += step) index.push(at, Math.min(at + step, spans[k + 1]));
  }
  return new Uint32Array(index);
}

/**
 * How many of rising numbers are at most `last`.
 * @param {Uint32Array} ends
 * @param {number} last
 */
function countUpTo(ends, last) {
  let [low, high] = [0, ends.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (ends[middle] <= last) low = middle + 1;
    else high = middle;
  }
  return low;
}
