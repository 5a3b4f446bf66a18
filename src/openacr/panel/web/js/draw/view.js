// The parallel projection of a Camera as three.js has it.
import { OrthographicCamera } from "../../vendor/three.js";
import { cross } from "./camera.js";

const FAR = 1e5;

export function newView() {
  const view = new OrthographicCamera();
  view.matrixAutoUpdate = false;
  return view;
}

/**
 * Make a view show what a camera sees.
 * @param {OrthographicCamera} view
 * @param {import("./camera.js").Camera} camera
 */
export function follow(view, camera) {
  const [half, tall] = [camera.width / 2 / camera.scale, camera.height / 2 / camera.scale];
  Object.assign(view, { left: -half, right: half, top: tall, bottom: -tall, near: -FAR, far: FAR });
  view.updateProjectionMatrix();
  const [r, u] = [camera.right, camera.up];
  const out = cross(r, u);
  view.matrix.set(
    r[0],
    u[0],
    out[0],
    camera.middle[0],
    r[1],
    u[1],
    out[1],
    camera.middle[1],
    r[2],
    u[2],
    out[2],
    camera.middle[2],
    0,
    0,
    0,
    1,
  );
  view.matrixWorldNeedsUpdate = true;
}
