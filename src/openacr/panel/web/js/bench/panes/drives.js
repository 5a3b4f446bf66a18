// DRIVES: every axis of the card with its drive: on, off, what is wrong and bars it, errors and outputs beside their limits.
import { get } from "../../core/api.js";
import { give, refuse, report } from "../../core/app.js";
import { fill, h, setText } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { Endings } from "../../core/signal.js";
import { language, t } from "../../core/texts.js";
import { confirm } from "../../frame/dialog.js";
import { mayMove } from "../../motion/actions.js";

const TEXTS = {
  drive: { en: "Drive", de: "Antrieb" },
  position: { en: "Position, units", de: "Position, Einheiten" },
  error: { en: "Following error, units", de: "Schleppfehler, Einheiten" },
  output: { en: "Output, V", de: "Ausgang, V" },
  wrong: { en: "What is wrong", de: "Was nicht stimmt" },
  on: { en: "ON", de: "EIN" },
  off: { en: "OFF", de: "AUS" },
  noIo: {
    en: "OFF, without drive I/O: it may be under power",
    de: "AUS, ohne Antriebs-E/A: sie kann unter Strom stehen",
  },
  homed: { en: "homed", de: "referenziert" },
  moves: { en: "moves", de: "bewegt sich" },
  fine: { en: "nothing", de: "nichts" },
  none: { en: "No program of the card has an axis.", de: "Kein Programm der Karte hat eine Achse." },
  of: { en: "{value} of {limit}", de: "{value} von {limit}" },
  unlimited: { en: "{value}, no limit", de: "{value}, keine Grenze" },
  onText: {
    en: "The drive of axis {axis} is switched on: the axis is under power, its position counts as it is now. Kills and latches of the axis are lifted.",
    de: "Der Antrieb der Achse {axis} wird eingeschaltet: Die Achse steht unter Strom, ihre Position zählt, wie sie jetzt ist. Sperren und Merker der Achse werden aufgehoben.",
  },
  offText: {
    en: "The drive of axis {axis} is switched off: a hanging axis without a brake falls.",
    de: "Der Antrieb der Achse {axis} wird ausgeschaltet: Eine hängende Achse ohne Bremse fällt.",
  },
  isOn: { en: "The drive of axis {axis} is on", de: "Der Antrieb der Achse {axis} ist ein" },
  isOff: { en: "The drive of axis {axis} is off", de: "Der Antrieb der Achse {axis} ist aus" },
  wasReset: { en: "The drive of axis {axis} is reset", de: "Der Antrieb der Achse {axis} ist zurückgesetzt" },
  allOff: { en: "All drives are off", de: "Alle Antriebe sind aus" },
  stop: { en: "Also a moving axis; no emergency stop", de: "Auch eine Achse in Bewegung; kein Not-Halt" },
};
/** What the server names, in German. @type {Record<string, string>} */
const WRONG = {
  "enable.open": "Der Motion Enable Input ist offen: Die 24 V fehlen",
  "enable.latched": "Der Motion Enable Input war offen: RÜCKSETZEN löscht den Merker",
  input: "Der Antrieb meldet eine Störung an seinem Störungseingang",
  encoder: "Der Geber der Achse meldet ein gestörtes Signal: ENC RES löscht das, sobald das Signal wieder da ist",
  fault: "Eine Störung des Antriebs ist gemerkt: RÜCKSETZEN löscht sie",
  excess: "Der Schleppfehler war zu groß: ANTRIEB EIN übernimmt die Position",
  killed: "Die Bewegung der Achse ist gesperrt: ANTRIEB EIN hebt das auf",
  "hard.plus": "Der positive Endschalter wurde erreicht: ANTRIEB EIN löscht den Merker",
  "hard.minus": "Der negative Endschalter wurde erreicht: ANTRIEB EIN löscht den Merker",
  "soft.plus": "Die positive Softwaregrenze wurde erreicht: ANTRIEB EIN löscht den Merker",
  "soft.minus": "Die negative Softwaregrenze wurde erreicht: ANTRIEB EIN löscht den Merker",
};
const EVERY_MS = 250; // from an answer to the next question
const DIGITS = 3;
const NEAR = 0.8; // of a limit

/**
 * @typedef {{ axis: number, name: string, title: string, is_enabled: boolean, has_io: boolean, is_jogged: boolean,
 *   is_homed: boolean, wrong: { key: string, text: string, bars: boolean }[], setpoint_u: number, actual_u: number,
 *   following_u: number, plus_error_u: number, minus_error_u: number, output_v: number, plus_output_v: number,
 *   minus_output_v: number }} Drive
 */

/**
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head }) {
  const endings = new Endings();
  const table = h("tbody", {});
  head.append(
    keyOf("stop.drives", async () => (await give("stop.drives")) && report(t(TEXTS.allOff)), ".danger", {
      title: t(TEXTS.stop),
    }),
  );
  host.append(
    h(
      "div.grow.scroll",
      { tabIndex: 0 },
      h(
        "table.grid.drives",
        {},
        h(
          "thead",
          {},
          h(
            "tr",
            {},
            ...[t("form.axis"), t(TEXTS.drive), t(TEXTS.position), t(TEXTS.error), t(TEXTS.output), t(TEXTS.wrong)].map(
              (text) => h("th", {}, text),
            ),
          ),
        ),
        table,
      ),
    ),
  );
  let isOpen = true;
  /** @type {string | null} */
  let shown = null;
  /** @type {ReturnType<typeof rowOf>[]} */
  let rows = [];
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;

  async function look() {
    const found = await get("card/drives").catch((error) => error);
    if (!isOpen) return;
    if (found instanceof Error) {
      shown = null;
      fill(table, h("tr", {}, h("td.refusal", { colSpan: 6 }, found.message)));
    } else draw(found.drives);
    timer = setTimeout(look, EVERY_MS);
  }

  /**
   * Rows stay the same elements as long as the axes do: a key that is being pressed is not replaced.
   * @param {Drive[]} drives
   */
  function draw(drives) {
    const names = drives.map(({ name }) => name).join();
    if (names !== shown) {
      shown = names;
      rows = drives.map(rowOf);
      fill(
        table,
        ...(rows.length ? rows.map(({ row }) => row) : [h("tr", {}, h("td", { colSpan: 6 }, t(TEXTS.none)))]),
      );
    }
    drives.forEach((drive, n) => rows[n].show(drive));
  }

  endings.add(() => {
    isOpen = false;
    clearTimeout(timer);
  });
  await look();
  return () => endings.end();
}

/** @param {Drive} first */
function rowOf(first) {
  let drive = first;
  const { name, title } = first;
  const state = h("strong.drive-state", {});
  const notes = h("div.quiet", {});
  const position = h("td.number.mono", {});
  const [error, output] = [bar(t(TEXTS.error)), bar(t(TEXTS.output))];
  const wrong = h("td", {});
  const key = (/** @type {import("../../core/texts.js").TextKey} */ label, /** @type {() => void} */ act) =>
    keyOf(label, act, "", { ariaLabel: `${t(label)} ${title}` });
  const keys = {
    on: key("drive.on", () => void on(drive)),
    off: key("drive.off", () => void off(drive)),
    reset: key("drive.reset", () => void reset(drive)),
  };
  let said = "";
  return {
    row: h(
      "tr",
      { data: { axis: name } },
      h("th", { scope: "row" }, title, notes),
      h("td", {}, h("div.row.wrap", {}, state, keys.on, keys.off, keys.reset)),
      position,
      h("td", {}, error.element),
      h("td", {}, output.element),
      wrong,
    ),
    /** @param {Drive} now */
    show(now) {
      drive = now;
      setText(state, t(now.is_enabled ? TEXTS.on : now.has_io ? TEXTS.off : TEXTS.noIo));
      state.classList.toggle("is-running", now.is_enabled);
      setText(
        notes,
        [now.is_homed && t(TEXTS.homed), now.is_jogged && t(TEXTS.moves)].filter(Boolean).join(" \u00b7 "),
      );
      keys.on.hidden = now.is_enabled;
      keys.off.hidden = !now.is_enabled;
      keys.reset.hidden = !now.wrong.length;
      setText(position, number(now.actual_u));
      error.show(now.following_u, now.minus_error_u, now.plus_error_u);
      output.show(now.output_v, now.minus_output_v, now.plus_output_v);
      const found = now.wrong.map((each) =>
        h(each.bars ? "div.refusal" : "div", { data: { wrong: each.key } }, inWords(each)),
      );
      const text = now.wrong.map((each) => each.key).join();
      if (text === said && wrong.firstChild) return;
      said = text;
      fill(wrong, ...(found.length ? found : [h("span.quiet", {}, t(TEXTS.fine))]));
    },
  };
}

/** @param {{ key: string, text: string }} wrong */
function inWords({ key, text }) {
  return language() === "de" ? (WRONG[key] ?? text) : text;
}

/**
 * A bar from a lower to an upper limit around 0, with the numbers below it.
 * @param {string} label
 */
function bar(label) {
  const mark = h("span", {});
  const track = h("div.drive-track", { role: "meter", ariaLabel: label }, mark);
  const text = h("span.number", {});
  const element = h("div.drive-bar", {}, track, text);
  return {
    element,
    /**
     * @param {number} value
     * @param {number} low
     * @param {number} high
     */
    show(value, low, high) {
      const limit = value < 0 ? low : high;
      const share = limit === 0 ? 0 : Math.min(1, Math.max(0, value / limit));
      mark.style.width = `${50 * share}%`;
      mark.style.left = value < 0 ? "auto" : "50%";
      mark.style.right = value < 0 ? "50%" : "auto";
      element.classList.toggle("is-near", share >= NEAR);
      Object.assign(track, { ariaValueNow: String(value), ariaValueMin: String(low), ariaValueMax: String(high) });
      const said = limit === 0 ? TEXTS.unlimited : TEXTS.of;
      const far = low === -high ? `\u00b1${number(high)}` : number(limit);
      setText(text, t(said, { value: number(value), limit: far }));
    },
  };
}

/** @param {number} value */
function number(value) {
  const digits = value.toFixed(DIGITS);
  return Number(digits) === 0 ? digits.replace("-", "") : digits.replace("-", "\u2212");
}

/** @param {Drive} drive */
async function on({ name, title: axis, wrong }) {
  const bars = wrong.filter((each) => each.bars).map(inWords);
  if (bars.length) return refuse(`${axis}: ${bars.join("; ")}`);
  if (!mayMove() || !(await confirm(t("drive.on"), t(TEXTS.onText, { axis }), t("drive.on")))) return;
  if (await give("drive.on", { axis: name })) report(t(TEXTS.isOn, { axis }));
}

/** @param {Drive} drive */
async function off({ name, title: axis }) {
  if (!(await confirm(t("drive.off"), t(TEXTS.offText, { axis }), t("drive.off")))) return;
  if (await give("drive.off", { axis: name })) report(t(TEXTS.isOff, { axis }));
}

/** @param {Drive} drive */
async function reset({ name, title: axis }) {
  if (await give("drive.reset", { axis: name })) report(t(TEXTS.wasReset, { axis }));
}
