// The path by WebGL: the points stay on the graphics card, only the camera changes.
import {
  BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments, OrthographicCamera, Scene, WebGLRenderer,
} from "../../vendor/three.js";
import { cross } from "./camera.js";
import { KIND, endOf } from "./path.js";

const FAR = 1e5;

/**
 * @param {HTMLCanvasElement} canvas
 * @returns {import("./flat.js").Painter}
 */
export function solidPainter(canvas) {
  const renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
  renderer.autoClear = false;
  const [scene, view] = [new Scene(), new OrthographicCamera()];
  view.matrixAutoUpdate = false;
  /** @type {import("./path.js").ToolPath | null} */
  let drawn = null;
  /** @type {LineSegments[]} */
  let lines = [];
  /** @type {LineSegments | null} */
  let cut = null;
  const dispose = () => {
    scene.clear();
    for (const each of [...lines, ...(cut ? [cut] : [])]) {
      each.geometry.dispose();
      /** @type {LineBasicMaterial} */ (each.material).dispose();
    }
    [lines, cut] = [[], null];
  };

  /**
   * Pairs of points of the parts, in the order of the path.
   * @param {import("./path.js").ToolPath} path
   * @param {(part: number) => boolean} isMeant
   */
  function pairs(path, isMeant) {
    const index = [];
    for (let n = 0; n < path.starts.length; n++) {
      if (!isMeant(n)) continue;
      for (let at = path.starts[n] + 1; at < endOf(path, n); at++) index.push(at - 1, at);
    }
    return new BufferAttribute(new Uint32Array(index), 1);
  }

  return {
    setPath(path) {
      dispose();
      drawn = path;
      if (!path) return;
      const places = new BufferAttribute(path.points, 3);
      const add = (/** @type {(part: number) => boolean} */ isMeant, /** @type {any} */ data) => {
        const geometry = new BufferGeometry().setAttribute("position", places).setIndex(pairs(path, isMeant));
        const line = new LineSegments(geometry, new LineBasicMaterial());
        line.frustumCulled = false;
        line.userData = data;
        scene.add(line);
        return line;
      };
      lines = [add((n) => path.kinds[n] === KIND.rapid, { color: null })];
      for (const color of new Set(path.colors)) lines.push(add((n) => path.kinds[n] !== KIND.rapid && path.colors[n] === color, { color }));
      cut = add(() => true, {});
      cut.visible = false;
    },
    paint(camera, colors, byPart) {
      renderer.setPixelRatio(1);
      renderer.setSize(canvas.width, canvas.height, false);
      const [half, tall] = [camera.width / 2 / camera.scale, camera.height / 2 / camera.scale];
      Object.assign(view, { left: -half, right: half, top: tall, bottom: -tall, near: -FAR, far: FAR });
      view.updateProjectionMatrix();
      const [r, u] = [camera.right, camera.up];
      const out = cross(r, u);
      view.matrix.set(r[0], u[0], out[0], camera.middle[0], r[1], u[1], out[1], camera.middle[1], r[2], u[2], out[2], camera.middle[2], 0, 0, 0, 1);
      view.matrixWorldNeedsUpdate = true;
      for (const line of lines) {
        const { color } = line.userData;
        line.visible = true;
        /** @type {LineBasicMaterial} */ (line.material).color.set(color === null ? colors.rapid : byPart ? byPart(color) : colors.feed);
      }
      if (cut) {
        cut.visible = false;
        /** @type {LineBasicMaterial} */ (cut.material).color.set(colors.cut);
      }
      renderer.clear();
      renderer.render(scene, view);
    },
    paintCut(from, to) {
      if (!cut || !drawn || to <= from) return;
      for (const line of lines) line.visible = false;
      cut.visible = true;
      cut.geometry.setDrawRange(2 * from, 2 * (to - from)); // the pair of point n is number n - 1
      renderer.render(scene, view);
    },
    close() {
      dispose();
      renderer.dispose();
    },
  };
}
