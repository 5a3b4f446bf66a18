// The solids of which the drawing of a machine is made: rails, hubs, bodies, switches.
import {
  BoxGeometry,
  CylinderGeometry,
  EdgesGeometry,
  GLTFLoader,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
  STLLoader,
  Vector3,
} from "../../vendor/three.js";
import { along } from "./kinematics.js";

/**
 * @typedef {import("./kinematics.js").Link} Link
 * @typedef {[number, number, number]} Point
 * @typedef {{ rail: string, end: string, grid: string, on: string, off: string, forced: string, edge: string }} Colours
 */

/** Bodies by the axis they belong to. */
/** @type {Readonly<Record<string, string>>} */
const BODIES = Object.freeze({ X: "#d2605a", Y: "#57a268", Z: "#4f82cf" });
export const OTHER = "#c59a3f";

/**
 * The parts of a link that stay (rail, ends, switches) and those that move (the body).
 * @param {Link} link
 */
export function partsOf(link) {
  const [fixed, moving] = [new Group(), new Group()];
  for (const group of [fixed, moving]) group.matrixAutoUpdate = false;
  const { rail, direction, low, high } = link;
  const rails = [
    link.is_rotary
      ? hub(direction, 1.1 * rail, 0.9 * rail)
      : bar(direction, low - 0.6 * rail, high + 0.6 * rail, 0.8 * rail),
  ];
  const ends =
    link.has_ends && !link.is_rotary
      ? [low - 0.6 * rail, high + 0.4 * rail].map((from) => bar(direction, from, from + 0.2 * rail, 1.5 * rail))
      : [];
  const switches = link.switches.map((each) => switchOf(link, each.low, each.high));
  const body = box(link.size, colourOf(link));
  body.position.set(...link.at);
  const edges = [new LineSegments(new EdgesGeometry(body.geometry), new LineBasicMaterial())];
  body.add(...edges);
  fixed.add(...rails, ...ends, ...switches);
  moving.add(body);
  return { fixed, moving, rails, ends, switches, body, edges };
}

/** @param {Link} link */
function colourOf(link) {
  return link.colour || (BODIES[link.name[0]?.toUpperCase()] ?? OTHER);
}

/**
 * A bar along a direction.
 * @param {Point} direction
 * @param {number} from
 * @param {number} to
 * @param {number} thick
 */
function bar(direction, from, to, thick) {
  const mesh = new Mesh(new BoxGeometry(to - from, thick, thick), new MeshLambertMaterial());
  mesh.quaternion.setFromUnitVectors(new Vector3(1, 0, 0), new Vector3(...direction));
  mesh.position.set(...along(direction, (from + to) / 2));
  return mesh;
}

/**
 * A hub about an axis of rotation.
 * @param {Point} direction
 * @param {number} radius
 * @param {number} high
 */
function hub(direction, radius, high) {
  const mesh = new Mesh(new CylinderGeometry(radius, radius, 2 * high, 32), new MeshLambertMaterial());
  mesh.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), new Vector3(...direction));
  return mesh;
}

/**
 * The sign of a switch beside its rail, as long as its range; about an axis that turns, in the middle of the range.
 * @param {Link} link
 * @param {number} low
 * @param {number} high
 */
function switchOf(link, low, high) {
  const thick = 0.5 * link.rail;
  const aside = new Vector3(...link.direction).cross(new Vector3(0, 0, 1));
  if (aside.length() < 0.01) aside.set(1, 0, 0);
  aside.normalize();
  if (link.is_rotary) {
    const sign = box([thick, thick, thick], OTHER);
    sign.position.copy(
      aside
        .multiplyScalar(2.9 * link.rail)
        .applyAxisAngle(new Vector3(...link.direction), ((low + high) / 360) * Math.PI),
    );
    return sign;
  }
  const middle = (low + high) / 2;
  const half = Math.max(thick, high - low) / 2;
  const sign = bar(link.direction, middle - half, middle + half, thick);
  sign.position.addScaledVector(aside, 1.5 * link.rail);
  return sign;
}

/**
 * @param {Point} size
 * @param {string} colour
 */
export function box(size, colour) {
  return new Mesh(new BoxGeometry(...size), new MeshLambertMaterial({ color: colour }));
}

/**
 * @param {Link} link
 * @param {ArrayBuffer} data
 */
export async function bodyFrom(link, data) {
  if (link.file.toLowerCase().endsWith(".glb")) return (await new GLTFLoader().parseAsync(data, "")).scene;
  return new Mesh(new STLLoader().parse(data), new MeshLambertMaterial({ color: colourOf(link) }));
}

/**
 * @param {Mesh} sign
 * @param {Colours} colours
 */
export function signColour(sign, colours) {
  const { isOn, isForced } = sign.userData;
  return isForced ? colours.forced : isOn ? colours.on : colours.off;
}

/**
 * @param {Mesh | LineSegments} what
 * @param {string} colour
 */
export function tint(what, colour) {
  /** @type {MeshLambertMaterial} */ (what.material).color.set(colour);
}
