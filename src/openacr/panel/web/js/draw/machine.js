// A machine in three dimensions: rails, bodies and switches of its axes, signs of its devices, the ground.
import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  DirectionalLight,
  HemisphereLight,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  Scene,
  Vector3,
  WebGLRenderer,
} from "../../vendor/three.js";
import { along, frames } from "./kinematics.js";
import { OTHER, bodyFrom, box, partsOf, signColour, tint } from "./solids.js";
import { follow, newView } from "./view.js";

/**
 * @typedef {import("./kinematics.js").Link} Link
 * @typedef {[number, number, number]} Point
 * @typedef {{ name: string, sign: { at: Point, parent: string } | null }} Device
 * @typedef {import("./solids.js").Colours} Colours
 * @typedef {{ positions: number[], isActive: (input: number, contact: "open" | "closed") => boolean,
 *   isForced: (input: number) => boolean, isBusy: (device: number) => boolean }} State
 */

const CELLS = 24; // of the ground, at most

/**
 * Draw a machine; the picture changes with `show` and is painted by `paint`.
 * @param {HTMLCanvasElement} canvas
 * @param {Link[]} links
 * @param {Device[]} devices
 */
export function machinePainter(canvas, links, devices) {
  const renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(1); // the canvas has the pixels of the screen
  const [scene, view, sun] = [new Scene(), newView(), new DirectionalLight("#ffffff", 1.9)];
  sun.position.set(0.5, -0.9, 1.6);
  scene.add(sun, new HemisphereLight("#ffffff", "#5a6068", 1.7));
  const parts = links.map(partsOf);
  const signs = devices.map(() => box([1, 1, 1], OTHER));
  for (const { fixed, moving } of parts) scene.add(fixed, moving);
  const extent = reach(links, parts);
  const size = extent.getSize(new Vector3());
  const unit = Math.max(size.x, size.y, size.z, 1) / 22;
  const places = devices.map((device, n) => placeOf(device, n, links, extent, unit));
  signs.forEach((sign, n) => {
    sign.scale.setScalar(unit);
    const { link, at } = places[n];
    sign.position.set(...at);
    (link === null ? scene : parts[link].moving).add(sign);
    if (link === null) extent.expandByPoint(new Vector3(...at).addScalar(unit));
  });
  const floor = extent.min.z;
  const posts = parts.flatMap(({ fixed }, n) =>
    links[n].parent === null && !links[n].is_rotary ? postsOf(links[n], fixed, floor) : [],
  );
  if (posts.length) scene.add(...posts);
  const grid = groundOf(extent, floor);
  scene.add(grid);
  let now = frames(links, []);

  return {
    /** What a fitted view shows: the corners of all that is drawn where it is now, without the ground. */
    corners() {
      scene.updateMatrixWorld();
      /** @type {Point[]} */
      const found = [];
      scene.traverse((each) => {
        if (each instanceof Mesh) found.push(...cornersOf(each));
      });
      return found;
    },
    /** @param {State} state */
    show(state) {
      now = frames(links, state.positions);
      parts.forEach(({ fixed, moving, switches }, n) => {
        fixed.matrix.fromArray(now[n].fixed);
        moving.matrix.fromArray(now[n].moving);
        switches.forEach((sign, k) => {
          const { input, contact } = links[n].switches[k];
          Object.assign(sign.userData, { isOn: state.isActive(input, contact), isForced: state.isForced(input) });
        });
      });
      signs.forEach((sign, n) => Object.assign(sign.userData, { isOn: state.isBusy(n), isForced: false }));
    },
    /** A point above the end of the rail of a link, or above its hub. @param {number} n */
    anchor(n) {
      const { is_rotary: turns, direction, high, rail } = links[n];
      const [x, y, z] = turns ? [0, 0, 0] : along(direction, high + 0.6 * rail);
      return pointOf(now[n].fixed, [x, y, z + rail]);
    },
    /** A point above the sign of a device. @param {number} n */
    signAnchor(n) {
      const { link, at } = places[n];
      const above = /** @type {Point} */ ([at[0], at[1], at[2] + unit]);
      return link === null ? above : pointOf(now[link].moving, above);
    },
    /**
     * @param {import("./camera.js").Camera} camera
     * @param {Colours} colours
     */
    paint(camera, colours) {
      renderer.setSize(canvas.width, canvas.height, false);
      follow(view, camera);
      tint(grid, colours.grid);
      for (const post of posts) tint(post, colours.rail);
      for (const { rails, ends, switches, edges } of parts) {
        for (const rail of rails) tint(rail, colours.rail);
        for (const end of ends) tint(end, colours.end);
        for (const edge of edges) tint(edge, colours.edge);
        for (const sign of switches) tint(sign, signColour(sign, colours));
      }
      for (const sign of signs) tint(sign, signColour(sign, colours));
      renderer.render(scene, view);
    },
    /**
     * Draw a body from a file in the place of its box.
     * @param {number} n
     * @param {ArrayBuffer} data
     */
    async setBody(n, data) {
      const body = await bodyFrom(links[n], data);
      body.position.set(...links[n].at);
      parts[n].moving.remove(parts[n].body);
      parts[n].moving.add(body);
    },
    close() {
      scene.traverse((each) => {
        if (each instanceof Mesh || each instanceof LineSegments) {
          each.geometry.dispose();
          for (const material of [each.material].flat()) material.dispose();
        }
      });
      renderer.dispose();
      renderer.forceContextLoss();
    },
  };
}

/**
 * The space that a machine takes at both ends of all its axes.
 * @param {Link[]} links
 * @param {ReturnType<typeof partsOf>[]} parts
 */
function reach(links, parts) {
  const extent = new Box3();
  for (const end of /** @type {const} */ (["low", "high"])) {
    const found = frames(
      links,
      links.map((link) => link[end] / link.per_unit),
    );
    parts.forEach(({ fixed, moving }, n) => {
      fixed.matrix.fromArray(found[n].fixed);
      moving.matrix.fromArray(found[n].moving);
      for (const group of [fixed, moving]) {
        group.updateMatrixWorld(true);
        extent.expandByObject(group);
      }
    });
  }
  return extent.isEmpty() ? extent.set(new Vector3(0, 0, 0), new Vector3(1, 1, 1)) : extent;
}

/**
 * Posts under both ends of a rail on the ground.
 * @param {Link} link
 * @param {import("../../vendor/three.js").Group} fixed
 * @param {number} floor
 */
function postsOf(link, fixed, floor) {
  const thick = 0.7 * link.rail;
  return [link.low, link.high].flatMap((end) => {
    const [x, y, z] = pointOf(fixed.matrix.elements, along(link.direction, end));
    const high = z - 0.4 * link.rail - floor;
    if (high < thick || Math.abs(link.direction[2]) > 0.5) return [];
    const post = box([thick, thick, high], OTHER);
    post.position.set(x, y, floor + high / 2);
    return [post];
  });
}

/**
 * The corners of the box about a solid, turned and moved with it.
 * @param {Mesh} mesh
 * @returns {Point[]}
 */
function cornersOf(mesh) {
  if (!mesh.geometry.boundingBox) mesh.geometry.computeBoundingBox();
  const { min, max } = /** @type {Box3} */ (mesh.geometry.boundingBox);
  return [min.x, max.x].flatMap((x) =>
    [min.y, max.y].flatMap((y) => [min.z, max.z].map((z) => pointOf(mesh.matrixWorld.elements, [x, y, z]))),
  );
}

/**
 * The ground under a machine: lines at whole steps.
 * @param {Box3} extent
 * @param {number} floor
 */
function groundOf(extent, floor) {
  const step = roundUp(Math.max(extent.max.x - extent.min.x, extent.max.y - extent.min.y, 1) / CELLS);
  const ends = (/** @type {"x" | "y"} */ side) => [
    step * (Math.floor(extent.min[side] / step) - 1),
    step * (Math.ceil(extent.max[side] / step) + 1),
  ];
  const [[left, right], [near, far]] = [ends("x"), ends("y")];
  const points = [];
  for (let x = left; x < right + step / 2; x += step) points.push(x, near, floor, x, far, floor);
  for (let y = near; y < far + step / 2; y += step) points.push(left, y, floor, right, y, floor);
  return new LineSegments(
    new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(points), 3)),
    new LineBasicMaterial(),
  );
}

/** The next of 1, 2, 5, 10 ... @param {number} value */
function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * /** @type {number} */ ([1, 2, 5, 10].find((each) => each * power >= value * 0.999));
}

/**
 * Where the sign of a device is: as machine.toml says, else in a row before the machine.
 * @param {Device} device
 * @param {number} n
 * @param {Link[]} links
 * @param {Box3} extent
 * @param {number} unit
 * @returns {{ link: number | null, at: Point }}
 */
function placeOf({ sign }, n, links, extent, unit) {
  if (!sign)
    return { link: null, at: [extent.min.x + (4 * n + 1) * unit, extent.min.y - 3 * unit, extent.min.z + unit / 2] };
  const link = links.findIndex((each) => each.name.toUpperCase() === sign.parent.toUpperCase());
  return { link: link < 0 ? null : link, at: sign.at };
}

/**
 * @param {number[]} matrix
 * @param {Point} point
 * @returns {Point}
 */
function pointOf(matrix, [x, y, z]) {
  return /** @type {Point} */ (
    [0, 1, 2].map((row) => matrix[row] * x + matrix[row + 4] * y + matrix[row + 8] * z + matrix[row + 12])
  );
}
