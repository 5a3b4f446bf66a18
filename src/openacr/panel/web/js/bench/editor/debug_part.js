// Breakpoints in the editor: set at line numbers, the line before which a program is held, and the keys that let it go.
import { give, model, refuse, report } from "../../core/app.js";
import { fill, h } from "../../core/dom.js";
import { keyOf, relabel } from "../../core/keys.js";
import { t } from "../../core/texts.js";
import { ask, askText } from "../../frame/dialog.js";

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
    en: "A program is held before the line, as by PAUSE: its moves slow down on their path and continue with it. Jogs, gears, cams, PLCs and other programs run on.",
    de: "Das Programm h\u00e4lt vor der Zeile wie mit PAUSE: Seine Bewegungen kommen auf ihrer Bahn zum Stillstand und laufen mit ihm weiter. Tippbetrieb, Getriebe, Kurven, SPS und andere Programme laufen weiter.",
  },
  remove: { en: "REMOVE", de: "ENTFERNEN" },
  clear: { en: "REMOVE ALL", de: "ALLE ENTFERNEN" },
  line: { en: "{name} line {line}", de: "{name} Zeile {line}" },
  condition: { en: "Hold where this is not 0", de: "Halten, wenn dies nicht 0 ist" },
  held: { en: "{name} is held before line {line}", de: "{name} h\u00e4lt vor Zeile {line}" },
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
const numberOf = (/** @type {string} */ name) => (name.startsWith("PROG") ? Number(name.slice(4)) : -1);
let reported = 0; // the last hold that was said, by any editor

/**
 * @typedef {import("../../edit/line_marks.js").StoredLines} StoredLines
 *
 * @param {{ level: () => string, stored: () => StoredLines | null, state: (level: string) => string,
 *   editor: () => ReturnType<typeof import("../../edit/controller_editor.js").createControllerEditor>,
 *   drawMarks: () => void }} pane
 */
export function debugPart({ level, stored, state, editor, drawMarks }) {
  const listKey = keyOf(TEXTS.list, () => void showList());
  const goKeys = GO_KEYS.map(([how, label, title]) => keyOf(label, () => void go(how), "", { title }));
  const bar = h("div.row.text-debug", { hidden: true, role: "toolbar", ariaLabel: t(TEXTS.keys) }, ...goKeys, listKey);
  const held = () => model.breakpoints.value.held;
  const isHeld = (/** @type {string} */ name) => held().some((each) => `PROG${each.program}` === name);

  /** The program that the keys act on: the one that is open, else one of the text that is held. */
  function program() {
    if (numberOf(level()) >= 0) return numberOf(level());
    return held().find((each) => stored()?.at(`PROG${each.program}`, each.line) !== null)?.program ?? -1;
  }

  /** @param {"on" | "over" | "into" | "out"} how */
  async function go(how) {
    if (program() < 0) refuse(t(TEXTS.noprogram));
    else await give("card.go", { program: program(), how });
  }

  /** @param {number} line of the text, from 1 */
  function placeAt(line) {
    const { why_not } = model.breakpoints.value;
    const place = stored()?.numberAt(editor().doc(), line);
    if (why_not || !place || numberOf(place.name) < 0) {
      refuse(why_not || t(TEXTS.unknown));
      return null;
    }
    return { name: place.name, program: numberOf(place.name), line: place.number };
  }

  const setAt = (/** @type {{ program: number, line: number }} */ place) =>
    model.breakpoints.value.breakpoints.find((each) => each.program === place.program && each.line === place.line);

  /** @param {number} line of the text, from 1 */
  async function toggle(line) {
    const place = placeAt(line);
    if (!place) return;
    const at = { program: place.program, line: place.line };
    await give(setAt(place) ? "break.clear" : "break.set", at);
  }

  /** @param {number} line of the text, from 1 */
  async function askCondition(line) {
    const place = placeAt(line);
    if (!place) return;
    const title = t(TEXTS.line, place);
    const condition = await askText(title, t(TEXTS.condition), setAt(place)?.condition ?? "");
    editor().focus();
    if (condition) await give("break.set", { program: place.program, line: place.line, condition });
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
              t(TEXTS.line, { name: `PROG${each.program}`, line: each.line }),
              each.condition ? h("span.mono", {}, `  ${each.condition}`) : "",
            ),
            keyOf(TEXTS.remove, () => give("break.clear", { program: each.program, line: each.line }), "", {
              ariaLabel: `${t(TEXTS.remove)} ${t(TEXTS.line, { name: `PROG${each.program}`, line: each.line })}`,
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
    for (const { program: number, line, hit } of held()) {
      if (hit <= reported) continue;
      reported = hit;
      report(t(TEXTS.held, { name: `PROG${number}`, line }));
      const at = stored()?.at(`PROG${number}`, line);
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
      for (const { program: number, line, condition } of breakpoints) {
        const at = stored()?.at(`PROG${number}`, line) ?? null;
        if (at !== null) found.push({ at, kind: "break", text: condition });
      }
      for (const { program: number, line } of held()) {
        const at = stored()?.at(`PROG${number}`, line) ?? null;
        if (at !== null) found.push({ at, kind: "held", text: `PROG${number}` });
      }
      return found;
    },
    draw() {
      const { breakpoints, why_not } = model.breakpoints.value;
      bar.hidden = Boolean(why_not) || level().startsWith("PLC") || !(breakpoints.length || held().length);
      relabel(listKey, TEXTS.list, { count: breakpoints.length });
      const name = program() < 0 ? "" : `PROG${program()}`;
      const isOff =
        !name || !model.may("service") || !(isHeld(name) || ["paused", "waits for STEP"].includes(state(name)));
      for (const each of goKeys) each.disabled = isOff;
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
