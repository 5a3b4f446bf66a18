// JOG of the workspace: AcroMill's keys, then every other axis of the card with a speed and a step in its own unit.
import { get, latest } from "../../core/api.js";
import { give, model, refuse } from "../../core/app.js";
import { evaluate } from "../../core/arithmetic.js";
import { cardAxes } from "../../core/card_axes.js";
import { fill, h, setText } from "../../core/dom.js";
import { Endings } from "../../core/signal.js";
import { t } from "../../core/texts.js";
import { needValues } from "../../core/values.js";
import { mayMove } from "../../motion/actions.js";
import { makeHeld, releaseAll } from "../../motion/hold.js";
import { screen } from "../../screens/jog.js";

const TEXTS = {
  others: { en: "Axes of the card", de: "Achsen der Karte" },
  position: { en: "Position, units", de: "Position, Einheiten" },
  speed: { en: "Speed, units/s", de: "Geschwindigkeit, Einheiten/s" },
  step: { en: "Step, units", de: "Schritt, Einheiten" },
  held: { en: "while held", de: "solange gedrückt" },
  perUnit: { en: "{ppu} pulses per unit", de: "{ppu} Pulse je Einheit" },
  none: { en: "No program of the card has an axis.", de: "Kein Programm der Karte hat eine Achse." },
  noSpeed: { en: "{axis}: give a speed above 0", de: "{axis}: Geschwindigkeit über 0 angeben" },
  badStep: {
    en: "{axis}: a step is a number above 0, or empty",
    de: "{axis}: Ein Schritt ist eine Zahl über 0, oder leer",
  },
  text: {
    en: "Hold a key to move; with a step, a press moves by it. The card's own ramps and limits hold. STOP is not an emergency stop.",
    de: "Taste halten zum Fahren; mit einem Schritt fährt ein Druck um ihn. Es gelten Rampen und Grenzen der Karte. STOP ist kein Not-Halt.",
  },
};
const VALUES = ["primary setpoint", "ppu", "jog veloc setting"];
const DIGITS = 4;

/**
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head, kept, keep }) {
  const endings = new Endings();
  const body = h("div.stack.grow.scroll", { tabIndex: 0 });
  host.append(body);
  const drawn = new Endings();
  const newest = latest(endings);
  let { lacks } = model.hello.value.machine;

  async function draw() {
    lacks = model.hello.value.machine.lacks;
    drawn.end();
    fill(body);
    const all = await newest(cardAxes());
    if (!all) return;
    const others = all.filter(({ isMachines }) => !isMachines);
    drawn.add(releaseAll);
    if (others.length < all.length) {
      const keys = h("div.jog-machine", {});
      body.append(keys);
      await screen.show({ body: keys, head, endings: drawn, args: {}, setTitle: () => {}, beforeClose: () => {} });
    }
    if (others.length) body.append(await cardKeys(others, drawn, kept, keep));
    else if (!all.length) body.append(h("p.hint", {}, t(TEXTS.none)));
  }

  endings.add(
    () => drawn.end(),
    model.hello.watch(({ machine }) => machine.lacks !== lacks && void draw()), // set up, or given away
  );
  await draw();
  return () => endings.end();
}

/**
 * A row for each axis: its position, speed, step and two keys.
 * @param {import("../../core/card_axes.js").CardAxis[]} axes
 * @param {Endings} endings
 * @param {Record<string, any>} kept speeds and steps, by the names of axes
 * @param {(values: Record<string, any>) => void} keep
 */
async function cardKeys(axes, endings, kept, keep) {
  const names = axes.flatMap(({ index }) => VALUES.map((name) => `axis${index}.${name}`));
  const { items } = await get("card/named", { names: names.join(";") });
  const rows = axes.map((axis, n) => rowOf(axis, items.slice(n * VALUES.length, (n + 1) * VALUES.length), kept));
  const remember = () => keep(Object.fromEntries(rows.flatMap(({ fields }) => fields.map((f) => [f.id, f.value]))));
  for (const { fields } of rows) for (const each of fields) each.addEventListener("change", remember);
  endings.add(
    needValues(
      items.map((/** @type {{ number: number }} */ { number }) => number),
      (values) => rows.forEach(({ show }) => show(values)),
    ),
  );
  return h(
    "section.stack.jog-card",
    { ariaLabel: t(TEXTS.others) },
    h(
      "table.grid",
      {},
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          h("th", {}, t("form.axis")),
          h("th", {}),
          ...[TEXTS.position, TEXTS.speed, TEXTS.step].map((text) => h("th.number", {}, t(text))),
        ),
      ),
      h("tbody", {}, ...rows.map(({ row }) => row)),
    ),
    h("p.hint", {}, t(TEXTS.text)),
  );
}

/**
 * @param {import("../../core/card_axes.js").CardAxis} axis
 * @param {{ number: number }[]} items its setpoint, pulses per unit, and jog speed on the card
 * @param {Record<string, any>} kept
 */
function rowOf({ name, title }, [setpoint, ppu, own], kept) {
  const speed = fieldOf(`jog-speed-${name}`, `${title}: ${t(TEXTS.speed)}`, kept);
  const step = fieldOf(`jog-step-${name}`, `${title}: ${t(TEXTS.step)}`, kept);
  step.placeholder = t(TEXTS.held);
  const position = h("td.number.live", { data: { position: name } }, "\u2013");
  const isHeld = () => !step.value.trim();

  /** The speed and the step that are typed; null where one is no number above 0. */
  function wanted() {
    const found = evaluate(speed.value);
    const distance = isHeld() ? 0 : evaluate(step.value);
    if (found === null || found <= 0) refuse(t(TEXTS.noSpeed, { axis: title }));
    else if (distance === null || (!isHeld() && distance <= 0)) refuse(t(TEXTS.badStep, { axis: title }));
    else return { speed: found, distance };
    return null;
  }

  const keys = /** @type {const} */ ([-1, 1]).map((direction) => {
    const key = h(
      "button.key.jog-key",
      { type: "button", ariaLabel: `${title} ${direction > 0 ? "plus" : "minus"}` },
      direction > 0 ? "+" : "\u2212",
    );
    makeHeld(
      key,
      () => ({ axis: name, direction, speed: wanted()?.speed ?? 0 }),
      () => isHeld() && wanted() !== null,
    );
    key.addEventListener("click", () => {
      const asked = isHeld() ? null : wanted();
      if (asked && mayMove()) void give("jog.increment", { axis: name, direction, ...asked, tick: model.drawnTick });
    });
    return key;
  });
  return {
    fields: [speed, step],
    row: h(
      "tr",
      { data: { axis: name } },
      h("th", { scope: "row" }, title),
      h("td", {}, h("div.row", {}, ...keys)),
      position,
      h("td.number", {}, speed),
      h("td.number", {}, step),
    ),
    show(/** @type {Map<number, number>} */ values) {
      const scale = values.get(ppu.number) || 1;
      const pulses = values.get(setpoint.number);
      setText(position, pulses === undefined ? "\u2013" : (pulses / scale).toFixed(DIGITS).replace("-", "\u2212"));
      position.title = t(TEXTS.perUnit, { ppu: scale });
      const present = values.get(own.number) ?? 0;
      if (!speed.value && !speed.dataset.known && present > 0) speed.value = String(Number(present.toPrecision(6)));
      if (values.has(own.number)) speed.dataset.known = "yes";
    },
  };
}

/**
 * A field for a number; another value ends what is held.
 * @param {string} id
 * @param {string} label
 * @param {Record<string, any>} kept
 */
function fieldOf(id, label, kept) {
  return h("input.field.number", {
    id,
    value: kept[id] ?? "",
    ariaLabel: label,
    inputMode: "decimal",
    autocomplete: "off",
    oninput: releaseAll,
  });
}
