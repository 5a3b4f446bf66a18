// The world around the card: its drawing, moving live, and what can be changed in it by hand.
import { get } from "../../core/api.js";
import { link, model } from "../../core/app.js";
import { h } from "../../core/dom.js";
import { Endings } from "../../core/signal.js";
import { t } from "../../core/texts.js";
import { deviceList, faultForm, inputTable } from "../world/controls.js";
import { createDrawing } from "../world/drawing.js";

const TEXTS = {
  controls: { en: "Inputs, faults and devices", de: "Eing\u00e4nge, Fehler und Ger\u00e4te" },
  inputs: { en: "Inputs", de: "Eing\u00e4nge" },
  faults: { en: "Faults", de: "Fehler" },
  devices: { en: "Devices", de: "Ger\u00e4te" },
};

/**
 * @typedef {object} About
 * @property {import("../../draw/kinematics.js").Link[]} links
 * @property {{ input: number, what: string, is_driven: boolean }[]} inputs
 * @property {{ axis: number, kind: string, why_not: string, key: string, unit: string, range: string }[]} faults
 * @property {{ name: string, kind: string, by_hand: Record<string, string>,
 *   sign: { at: [number, number, number], parent: string } | null }[]} devices
 * @property {string} why_not why nothing can be changed; "" where it can
 */

const HZ = 25;

/** @param {HTMLElement} host */
export async function mount(host) {
  const endings = new Endings();
  /** @type {About} */
  const about = await get("world");
  const view = h("div.world-view", {});
  const [inputs, faults, devices] = [inputTable(about.inputs), faultForm(about), deviceList(about.devices)];
  const side = about.why_not
    ? h("p.notice.world-note", {}, about.why_not)
    : h(
        "div.world-side.scroll",
        { tabIndex: 0, role: "region", ariaLabel: t(TEXTS.controls) },
        h("h3", {}, t(TEXTS.faults)),
        ...faults.elements,
        ...(devices.elements.length ? [h("h3", {}, t(TEXTS.devices)), ...devices.elements] : []),
        h("h3", {}, t(TEXTS.inputs)),
        ...inputs.elements,
      );
  host.append(h("div.world", {}, view, side));
  const drawing = createDrawing(view, endings, about);

  /** @param {import("../../core/frames.js").World} world */
  function show(world) {
    const busy = world.devices.map((device) => Object.values(device.commands).includes(true));
    drawing.show(
      {
        positions: world.positions,
        isActive: (input, contact) => world.on.includes(input) !== (contact === "closed"),
        isForced: (input) => world.forced.includes(input),
        isBusy: (n) => busy[n],
      },
      about.links.map((each, n) => nameOf(each, world.positions[n] ?? 0)),
      about.devices.map(({ name }, n) => `${name} ${signalsOn(world.devices[n])}`.trim()),
    );
    if (about.why_not) return;
    inputs.show(world);
    faults.show(world);
    devices.show(world);
  }

  show({ ...NOTHING, devices: about.devices.map(() => ({ commands: {}, signals: {} })) });
  if (about.why_not)
    endings.add(
      model.status.watch((status) => status && show({ ...NOTHING, positions: positionsOf(about, status.actual) })),
    );
  else
    endings.add(
      link.subscribe({ topic: "world", hz: HZ }),
      model.world.watch((world) => world && show(world)),
      () => {
        model.world.value = null;
      },
    );
  return () => endings.end();
}

const NOTHING = Object.freeze({ positions: [], on: [], forced: [], faults: [], devices: [] });

/**
 * The positions that a card shows, in the order of the links.
 * @param {About} about
 * @param {Float64Array} actual in the order of the axes of the machine
 */
function positionsOf({ links }, actual) {
  return links.map((each) => actual[model.axes.findIndex((axis) => axis.index === each.axis)] ?? 0);
}

/**
 * @param {import("../../draw/kinematics.js").Link} axis
 * @param {number} position
 */
function nameOf({ name, units }, position) {
  return `${name} ${position.toFixed(3).replace("-", "\u2212")} ${units}`;
}

/** @param {import("../../core/frames.js").DeviceState} device */
function signalsOn(device) {
  return Object.entries(device.signals)
    .filter(([, value]) => value === true)
    .map(([name]) => name)
    .join(", ");
}
