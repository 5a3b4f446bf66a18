// Breakpoints in the editor: set at line numbers, the line before which a program is held, and the keys that let it go.
import { give, model, refuse, report } from "../../core/app.js";
import { fill, h } from "../../core/dom.js";
import { keyOf, relabel } from "../../core/keys.js";
import { t } from "../../core/texts.js";
import { ask, askText } from "../../frame/dialog.js";
import { which } from "./card_text.js";

const TEXTS = {
  keys: { en: "Breakpoints and steps", de: "Haltepunkte und Schritte" },
  on: { en: "GO ON", de: "WEITER" },
  over: { en: "STEP OVER", de: "\u00dcBERSPRINGEN" },
  into: { en: "STEP INTO", de: "HINEINSPRINGEN" },
  out: { en: "STEP OUT", de: "HERAUSSPRINGEN" },
  list: { en: "BREAKPOINTS: {count}", de: "HALTEPUNKTE: {count}" },
  title: { en: "Breakpoints", de: "Haltepunkte" },
  none: {
    en: "No breakpoint is set. A press on a line number sets one (F9); a right press asks for its condition (Shift-F9).",
    de: "Kein Haltepunkt ist gesetzt. Ein Druck auf eine Zeilennummer setzt einen (F9), die rechte Taste fragt nach seiner Bedingung (Umschalt-F9).",
  },
  about: {
    en: "A program is held before the line, as by PAUSE: its moves slow down on their path and continue with it. Jogs, gears, cams, PLCs and other programs run on. A PLC is held after the scan that changes a coil of the line: it scans no more, its outputs stay as they are, its timers run on.",
    de: "Das Programm h\u00e4lt vor der Zeile wie mit PAUSE: Seine Bewegungen kommen auf ihrer Bahn zum Stillstand und laufen mit ihm weiter. Tippbetrieb, Getriebe, Kurven, SPS und andere Programme laufen weiter. Eine SPS h\u00e4lt nach dem Zyklus, der eine Spule der Zeile \u00e4ndert: Sie wird nicht mehr bearbeitet, ihre Ausg\u00e4nge bleiben, wie sie sind, ihre Zeitglieder laufen weiter.",
  },
  remove: { en: "REMOVE", de: "ENTFERNEN" },
  clear: { en: "REMOVE ALL", de: "ALLE ENTFERNEN" },
  line: { en: "{name} line {line}", de: "{name} Zeile {line}" },
  condition: { en: "Hold where this is not 0", de: "Halten, wenn dies nicht 0 ist" },
  held: { en: "{name} is held before line {line}", de: "{name} h\u00e4lt vor Zeile {line}" },
  changed: {
    en: "{name} is held: its scan has changed a coil of line {line}",
    de: "{name} h\u00e4lt: Ihr Zyklus hat eine Spule der Zeile {line} ge\u00e4ndert",
  },
  unknown: {
    en: "The card has another text here, or none: DOWNLOAD or READ first",
    de: "Die Karte hat hier einen anderen Text oder keinen: erst SENDEN oder LESEN",
  },
  noprogram: { en: "Choose a program that runs", de: "Ein Programm w\u00e4hlen, das l\u00e4uft" },
};

/** @type {["on" | "over" | "into" | "out", import("../../core/texts.js").Said, string][]} */
const GO_KEYS = [
  ["on", TEXTS.on, "F5"],
  ["over", TEXTS.over, "F10"],
  ["into", TEXTS.into, "F11"],
  ["out", TEXTS.out, "Shift-F11"],
];
/** PROG3 or PLC0. @param {import("../../core/model.js").CodePlace} place */
const nameOf = ({ program, plc }) => (plc === undefined ? `PROG${program}` : `PLC${plc}`);
const isPlc = (/** @type {string} */ name) => name.startsWith("PLC");
let reported = 0; // the last hold that was said, by any editor

/**
 * @typedef {import("../../edit/line_marks.js").StoredLines} StoredLines
 *
 * @param {{ level: () => string, stored: () => StoredLines | null, known: () => Promise<StoredLines | null>, state: (level: string) => string,
 *   editor: () => ReturnType<typeof import("../../edit/controller_editor.js").createControllerEditor>,
 *   drawMarks: () => void }} pane
 */
export function debugPart({ level, stored, known, state, editor, drawMarks }) {
  const listKey = keyOf(TEXTS.list, () => void showList());
  const goKeys = GO_KEYS.map(([how, label, title]) => keyOf(label, () => void go(how), "", { title }));
  const bar = h("div.row.text-debug", { hidden: true, role: "toolbar", ariaLabel: t(TEXTS.keys) }, ...goKeys, listKey);
  const held = () => model.breakpoints.value.held;
  const isHeld = (/** @type {string} */ name) => held().some((each) => nameOf(each) === name);

  /** The program that the keys act on: the one that is open, else one of the text that is held; empty without one. */
  function program() {
    const found = level() ? null : held().find((each) => stored()?.at(nameOf(each), each.line) !== null);
    return found ? nameOf(found) : level();
  }

  /** @param {"on" | "over" | "into" | "out"} how */
  async function go(how) {
    if (!program()) refuse(t(TEXTS.noprogram));
    else await give("card.go", { ...which(program()), how });
  }

  /** @param {number} line of the text, from 1 */
  async function placeAt(line) {
    const { why_not } = model.breakpoints.value;
    const place = (await known())?.numberAt(editor().doc(), line);
    if (why_not || !place) {
      refuse(why_not || t(TEXTS.unknown));
      return null;
    }
    return { name: place.name, line: place.number };
  }

  const setAt = (/** @type {{ name: string, line: number }} */ place) =>
    model.breakpoints.value.breakpoints.find((each) => nameOf(each) === place.name && each.line === place.line);

  /** @param {number} line of the text, from 1 */
  async function toggle(line) {
    const place = await placeAt(line);
    if (!place) return;
    await give(setAt(place) ? "break.clear" : "break.set", { ...which(place.name), line: place.line });
  }

  /** @param {number} line of the text, from 1 */
  async function askCondition(line) {
    const place = await placeAt(line);
    if (!place) return;
    const title = t(TEXTS.line, place);
    const condition = await askText(title, t(TEXTS.condition), setAt(place)?.condition ?? "");
    editor().focus();
    if (condition) await give("break.set", { ...which(place.name), line: place.line, condition });
  }

  async function showList() {
    const rows = h("div.list", {});
    const draw = () => {
      const { breakpoints } = model.breakpoints.value;
      fill(
        rows,
        ...breakpoints.map((each) =>
          h(
            "div.row",
            {},
            h(
              "span.grow",
              {},
              t(TEXTS.line, { name: nameOf(each), line: each.line }),
              each.condition ? h("span.mono", {}, `  ${each.condition}`) : "",
            ),
            keyOf(TEXTS.remove, () => give("break.clear", { ...which(nameOf(each)), line: each.line }), "", {
              ariaLabel: `${t(TEXTS.remove)} ${t(TEXTS.line, { name: nameOf(each), line: each.line })}`,
            }),
          ),
        ),
        ...(breakpoints.length ? [] : [h("p.hint", {}, t(TEXTS.none))]),
      );
    };
    const end = model.breakpoints.watch(draw);
    const chosen = await ask({
      title: t(TEXTS.title),
      body: [rows, h("p.hint", {}, t(TEXTS.about))],
      choices: [
        { text: t(TEXTS.clear), value: "clear", kind: "danger" },
        { text: t("key.close"), value: null },
      ],
    });
    end();
    if (chosen) await give("break.clear");
  }

  /** Say a new hold once, and bring its line into view. */
  function follow() {
    for (const each of held()) {
      if (each.hit <= reported) continue;
      reported = each.hit;
      const [name, line] = [nameOf(each), each.line];
      report(t(isPlc(name) ? TEXTS.changed : TEXTS.held, { name, line }));
      const at = stored()?.at(name, line);
      if (at !== null && at !== undefined) editor().see(at);
    }
  }

  const here = () => editor().about().line + 1;
  return {
    bar,
    holds: isHeld,
    /**
     * What an editor gets of it, beside other keys.
     * @param {Record<string, () => void>} others
     */
    editing: (others) => ({
      lineChosen: (/** @type {number} */ line, /** @type {boolean} */ isRight) =>
        void (isRight ? askCondition(line) : toggle(line)),
      keys: {
        ...others,
        F9: () => void toggle(here()),
        "Shift-F9": () => void askCondition(here()),
        F5: () => void go("on"),
        F10: () => void go("over"),
        F11: () => void go("into"),
        "Shift-F11": () => void go("out"),
      },
    }),
    /** The marks of breakpoints and of lines before which programs are held. */
    marks() {
      /** @type {import("../../edit/line_marks.js").LineMark[]} */
      const found = [];
      const { breakpoints } = model.breakpoints.value;
      for (const each of breakpoints) {
        const at = stored()?.at(nameOf(each), each.line) ?? null;
        if (at !== null) found.push({ at, kind: "break", text: each.condition });
      }
      for (const each of held()) {
        const at = stored()?.at(nameOf(each), each.line) ?? null;
        if (at !== null) found.push({ at, kind: "held", text: nameOf(each) });
      }
      return found;
    },
    draw() {
      const { breakpoints, why_not } = model.breakpoints.value;
      bar.hidden = Boolean(why_not) || !(breakpoints.length || held().length);
      relabel(listKey, TEXTS.list, { count: breakpoints.length });
      const name = program();
      const isOff =
        !name || !model.may("service") || !(isHeld(name) || ["paused", "waits for STEP"].includes(state(name)));
      for (const [n, each] of goKeys.entries()) each.disabled = isOff || (n > 0 && isPlc(name)); // a scan has no steps
    },
    /** Follow the breakpoints of the card; returns the function that ends it. */
    watch() {
      return model.breakpoints.watch(() => {
        follow();
        this.draw();
        drawMarks();
      });
    },
  };
}
