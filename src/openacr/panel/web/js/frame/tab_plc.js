// The PLC tab: one PLC of the card as a live ladder with its listing; what cannot be drawn is shown as text.
import { get, latest } from "../core/api.js";
import { model, refuse } from "../core/app.js";
import { fill, h, setText } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { needWords, stateOf, wordsOf } from "../core/flags.js";
import { lineNames } from "../core/own_names.js";
import { keepSetting, setting } from "../core/settings.js";
import { Endings } from "../core/signal.js";
import { t } from "../core/texts.js";
import { needValues } from "../core/values.js";
import { drawRung } from "../draw/ladder.js";
import { walkLadder } from "../draw/ladder_keys.js";
import { fullName } from "./card_value.js";

const COUNT = 8;
const WIDE = 560; // room for ladder and listing side by side
const [RUNNING, EACH] = [1536, 32]; // flag "PLC Running" of PLC 0, flags of a PLC
const COUNTS = Object.freeze({ timer: 6661, counter: 6663 }); // of PLC 0; the preload is the parameter before
const NOTHING = "User Defined"; // the name of a flag that the card leaves to its user
const PARAMETERS = 16; // of a PLC

/**
 * @param {HTMLElement} panel
 * @param {import("../core/signal.js").Endings} endings
 */
export async function plcTab(panel, endings) {
  const own = new Endings();
  endings.add(() => own.end());
  let plc = Number(setting("plc", "0"));
  let hasList = setting("plc-list", panel.clientWidth < WIDE ? "off" : "on") === "on";
  const state = h("span.grow", { role: "status" });
  const choice = h(
    "select.field",
    { ariaLabel: t("plc.choose"), onchange: () => choose(Number(choice.value)) },
    ...Array.from({ length: COUNT }, (_each, n) => h("option", { value: String(n) }, `PLC${n}`)),
  );
  const listKey = keyOf("plc.listing", () => toggleList());
  const ladder = h("div.ladder.scroll", { tabIndex: 0, role: "region", ariaLabel: t("plc.ladder") });
  const about = h("p.hint.ladder-about", { hidden: true });
  /** The symbol that had the focus last. @type {SVGElement | null} */
  let chosen = null;
  const tell = () => {
    about.hidden = !chosen?.isConnected;
    setText(about, chosen?.getAttribute("aria-label") ?? "");
  };
  const list = h("pre.plc-list.mono.scroll", { tabIndex: 0, role: "region", ariaLabel: t("plc.listing") });
  panel.append(
    h(
      "div.row.pane-tools",
      {},
      choice,
      state,
      listKey,
      keyOf("plc.read", () => choose(plc)),
    ),
    h("div.plc-view.grow", {}, ladder, list),
    about,
  );
  walkLadder(ladder, (symbol) => {
    chosen = symbol;
    tell();
  });
  const names = lineNames();
  const newest = latest(endings);

  /** @param {boolean} on */
  function showList(on) {
    listKey.ariaPressed = String(on);
    list.hidden = !on;
  }

  function toggleList() {
    hasList = Boolean(list.hidden);
    keepSetting("plc-list", hasList ? "on" : "off");
    showList(hasList);
  }

  /** @param {number} number */
  async function choose(number) {
    plc = number;
    keepSetting("plc", String(number));
    choice.value = String(number);
    const found = await newest(meant(get("card/ladder", { plc }), names)).catch((error) => void refuse(error));
    if (!found) return;
    own.end();
    show(...found);
  }

  /**
   * @param {{ lines: { number: number, text: string }[], rungs: import("../draw/ladder.js").Rung[],
   *   why: string }} found
   * @param {Map<number, string>} named
   */
  function show({ lines, rungs, why }, named) {
    setText(list, lines.map((line) => `${String(line.number).padStart(5)} ${line.text}`).join("\n"));
    const drawn = rungs.map((rung) => drawRung(rung, (flag) => named.get(flag) ?? ""));
    fill(
      ladder,
      ...(drawn.length
        ? drawn.map((each) => each.element)
        : [h("p.notice", {}, lines.length ? t("plc.notdrawn", { why: why || t("plc.norung") }) : t("plc.empty"))]),
    );
    ladder.querySelector(".symbol")?.setAttribute("tabindex", "0");
    tell();
    showList(lines.length > 0 && (hasList || !drawn.length));
    const symbols = rungs.flatMap((rung) => rung.symbols);
    const flags = symbols.flatMap((symbol) => symbol.flag ?? []);
    const boxes = symbols
      .filter((symbol) => symbol.kind in COUNTS)
      .map((symbol) => countAt(symbol.kind, symbol.number ?? 0));
    /** @type {Map<number, number>} */
    let values = new Map();
    let wasRunning = /** @type {boolean | undefined} */ (undefined);
    const update = () => {
      const isRunning = stateOf(model.flags.value, RUNNING + EACH * plc);
      setText(state, isRunning === undefined ? "" : t(isRunning ? "plc.running" : "plc.halted"));
      state.classList.toggle("is-running", isRunning === true);
      for (const each of drawn)
        each.update(
          (flag) => stateOf(model.flags.value, flag),
          isRunning === true,
          (kind, number) => countOf(values, kind, number),
        );
      tell();
      if (wasRunning === false && isRunning) void choose(plc); // another text may have been started
      wasRunning = isRunning;
    };
    own.add(needWords(wordsOf([RUNNING + EACH * plc, ...flags])), model.flags.watch(update));
    if (boxes.length)
      own.add(
        needValues(
          boxes.flatMap((at) => [at - 1, at]),
          (known) => {
            values = known;
            update();
          },
        ),
      );
  }
  endings.add(model.texts.watch((stored) => stored && ["", `PLC${plc}`].includes(stored.name) && void choose(plc)));
  await choose(Math.min(COUNT - 1, Math.max(0, plc || 0)));
}

/**
 * A ladder with what its flags mean: their aliases, else the names of inputs and outputs, else those of the card.
 * @param {Promise<{ lines: { number: number, text: string }[], rungs: import("../draw/ladder.js").Rung[],
 *   why: string, names: Record<string, string> }>} reading
 * @param {Promise<Record<string, string>>} names
 * @returns {Promise<[any, Map<number, string>]>}
 */
async function meant(reading, names) {
  const [ladder, places] = await Promise.all([reading, names]);
  const named = new Map(Object.entries(places).map(([id, name]) => [Number(id.slice("BIT".length)), name]));
  for (const [flag, alias] of Object.entries(ladder.names)) named.set(Number(flag), alias);
  const flags = new Set(
    ladder.rungs
      .flatMap((rung) => rung.symbols)
      .filter((symbol) => symbol.number === null)
      .flatMap((symbol) => symbol.flag ?? [])
      .filter((flag) => !named.has(flag)),
  );
  if (!flags.size) return [ladder, named];
  const { items } = await get("card/named", { names: [...flags].map((flag) => `BIT${flag}`).join(";") }).catch(() => ({
    items: [],
  }));
  return [
    ladder,
    new Map([
      ...named,
      ...items
        .filter((/** @type {any} */ each) => each.name !== NOTHING)
        .map(
          (/** @type {import("./card_value.js").Item} */ each) =>
            /** @type {[number, string]} */ ([each.number, fullName(each)]),
        ),
    ]),
  ];
}

/**
 * The parameter that counts.
 * @param {string} kind
 * @param {number} number
 */
function countAt(kind, number) {
  return COUNTS[/** @type {keyof typeof COUNTS} */ (kind)] + PARAMETERS * number;
}

/**
 * @param {Map<number, number>} values
 * @param {string} kind
 * @param {number} number
 */
function countOf(values, kind, number) {
  const at = countAt(kind, number);
  return `${values.get(at) ?? "\u2013"}/${values.get(at - 1) ?? "\u2013"}`;
}
