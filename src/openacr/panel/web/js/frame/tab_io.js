// The I/O STATUS tab: every input and output of the card and its modules with name and state.
import { get } from "../core/api.js";
import { model, refuse } from "../core/app.js";
import { fill, h, setText } from "../core/dom.js";
import { needWords, stateOf } from "../core/flags.js";
import { Endings } from "../core/signal.js";
import { t } from "../core/texts.js";

/** @typedef {{ number: number, name: string }} Point */

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export async function ioTab(panel, endings) {
  panel.classList.add("scroll");
  const host = h("div.io-host", {});
  panel.append(host);
  const own = new Endings();
  endings.add(() => own.end());
  const show = async () => {
    const { inputs, outputs, words } = await get("io");
    own.end();
    const [left, right] = [columnOf(t("io.inputs"), inputs), columnOf(t("io.outputs"), outputs)];
    fill(host, left.element, right.element);
    own.add(
      needWords(words),
      model.flags.watch((states) => [left, right].forEach(({ draw }) => draw(states))),
      model.forced.watch(() => [left, right].forEach(({ draw }) => draw(model.flags.value))),
    );
  };
  await show().catch(refuse);
  // Names, card model and number of modules are settings.
  endings.add(model.changed.watch(({ what }) => what === "forms" && void show().catch(refuse)));
}

/**
 * @param {string} title
 * @param {Point[]} points
 */
function columnOf(title, points) {
  const rows = points.map((point, n) => {
    const [lamp, state] = [h("span.lamp", { ariaHidden: "true" }), h("span.io-state", {})];
    return {
      point,
      lamp,
      state,
      element: h(
        "div.io-row",
        { data: { bit: String(point.number), item: `BIT${point.number}` }, tabIndex: n === 0 ? 0 : -1 },
        lamp,
        h("span.number", {}, String(point.number)),
        h("span.io-name", { title: point.name }, point.name),
        state,
      ),
    };
  });
  const element = h(
    "section.block",
    { ariaLabel: title },
    h("h3", {}, title),
    h("div.io-list", { onkeydown: move }, ...rows.map((row) => row.element)),
  );
  const draw = (/** @type {Map<number, number>} */ words) => {
    const { forced } = model.forced.value;
    for (const { point, lamp, state } of rows) {
      const isOn = stateOf(words, point.number);
      lamp.classList.toggle("is-on", isOn === true);
      const isForced = forced.some(({ input }) => input === point.number);
      const text = isForced ? (isOn ? "io.forced.on" : "io.forced.off") : isOn ? "io.on" : "io.off";
      setText(state, isOn === undefined ? "\u2013" : t(text));
    }
  };
  return { element, draw };
}

/** Arrow keys go through the rows, of which Tab reaches one. @param {KeyboardEvent} event */
function move(event) {
  const row = /** @type {HTMLElement} */ (event.target);
  const next = { ArrowDown: row.nextElementSibling, ArrowUp: row.previousElementSibling }[event.key];
  if (!(next instanceof HTMLElement)) return;
  event.preventDefault();
  row.tabIndex = -1;
  next.tabIndex = 0;
  next.focus();
}
