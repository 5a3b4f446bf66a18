// PROGRAM/PLC: the programs and PLCs of the card, what each of them does, its text; run, halt, step, listen, edit,
// clear.
import { get, latest } from "../core/api.js";
import { give, link, model, refuse, report } from "../core/app.js";
import { fill, h, setText } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { chosenProgram, firstProgram, needPrograms } from "../core/programs.js";
import { t, textOr } from "../core/texts.js";
import { ask, confirm } from "../frame/dialog.js";
import { createListing } from "../frame/listing.js";

const TEXTS = {
  list: { en: "Programs and PLCs", de: "Programme und SPS" },
  text: { en: "Text as the card lists it", de: "Text, wie ihn die Karte auflistet" },
  printed: { en: "What the program prints", de: "Ausgaben des Programms" },
  choose: { en: "Choose a program", de: "Programm wählen" },
  bytes: { en: "{used} bytes", de: "{used} Byte" },
  differs: { en: "≠ project", de: "≠ Projekt" },
  differsText: {
    en: "Its text on the card is another one than in the project: it is lost with the process of the panel unless it is saved into the project (Editor)",
    de: "Auf der Karte steht ein anderer Text als im Projekt: er geht mit dem Prozess des Panels verloren, wenn er nicht ins Projekt gespeichert wird (Editor)",
  },
  nomemory: { en: "no memory", de: "kein Speicher" },
  run: { en: "RUN", de: "START" },
  halt: { en: "HALT", de: "HALT" },
  pause: { en: "PAUSE", de: "PAUSE" },
  resume: { en: "RESUME", de: "WEITER" },
  block: { en: "BLOCK", de: "EINZEL" },
  step: { en: "STEP", de: "SCHRITT" },
  listen: { en: "LISTEN", de: "MITHÖREN" },
  edit: { en: "EDIT", de: "ÄNDERN" },
  clear: { en: "CLEAR", de: "LÖSCHEN" },
  send: { en: "SEND", de: "SENDEN" },
  sent: {
    en: "{name}: {count} {count|line is|lines are} stored on the card",
    de: "{name}: {count} {count|Zeile ist|Zeilen sind} auf der Karte gespeichert",
  },
  runTitle: { en: "Start {name}?", de: "{name} starten?" },
  runText: {
    en: "A program of the card can move axes at once. STOP pauses it; it is not held by the overrides of this machine.",
    de: "Ein Programm der Karte kann sofort Achsen bewegen. STOP hält es an; die Overrides dieser Maschine wirken nicht darauf.",
  },
  clearTitle: { en: "Erase {name}?", de: "{name} löschen?" },
  clearText: {
    en: "Its lines are erased from the memory of the card.",
    de: "Seine Zeilen werden im Speicher der Karte gelöscht.",
  },
  cleared: { en: "{name} is empty", de: "{name} ist leer" },
};

/**
 * @typedef {{ name: string, state: string, line?: number, block?: boolean }} State
 * @typedef {State & { bytes: number, used: number, owner: string }} Listed
 */

const HALTED = "halted";

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "Programs and PLCs of the card", de: "Programme und SPS der Karte" },
  area: "full",
  async show({ body, head, endings, args, beforeClose }) {
    /** @type {Listed[]} */
    let listed = [];
    /** @type {Map<string, State>} */
    let states = new Map();
    let name = "";
    /** @type {{ number: number, text: string }[]} */
    let lines = [];
    let isRead = false; // `lines` are those of the chosen program
    let listened = "";
    const [newest, newestList, newestProject] = [latest(endings), latest(endings), latest(endings)];
    const items = h("div.list.scroll.program-list", { role: "listbox", ariaLabel: t(TEXTS.list) });
    const title = h("strong", { role: "status" });
    const keys = h("div.program-keys", {});
    const text = h("textarea.field.mono.grow", {
      ariaLabel: t(TEXTS.text),
      spellcheck: false,
      wrap: "off",
      hidden: true,
    });
    const place = h("div.program-text.grow", {});
    const printed = h("pre.listing-plain.mono.printed", {
      role: "log",
      ariaLabel: t(TEXTS.printed),
      tabIndex: 0,
      hidden: true,
    });
    body.classList.add("is-tabbed");
    body.append(items, h("div.program-side", {}, title, keys, place, text, printed));
    const listing = createListing(place, {
      read: async (first, count) => lines.slice(first - 1, first - 1 + count).map((each) => each.text),
      numberOf: (row) => String(lines[row - 1]?.number ?? ""),
      clicked: () => {},
      scrolled: () => {},
      label: t(TEXTS.text),
    });
    head.append(keyOf("programs.read", () => readList()));

    /** @type {string[]} */
    let differing = []; // from the project of the card
    const isEdited = () => !text.hidden && text.value !== textOf(lines);
    const which = () => (name.startsWith("PLC") ? { plc: Number(name.slice(3)) } : { program: Number(name.slice(4)) });
    beforeClose(mayDrop);

    async function mayDrop() {
      if (!isEdited()) return true;
      const chosen = await ask({
        title: t("edit.leave"),
        body: [h("p", {}, t("edit.leave.text", { name }))],
        choices: [
          { text: t("key.cancel"), value: "stay" },
          { text: t("form.drop"), value: "drop", kind: "danger" },
          { text: t(TEXTS.send), value: "send" },
        ],
      });
      return chosen === "drop" || (chosen === "send" && (await send()));
    }

    async function readList() {
      const found = await newestList(get("card/programs")).catch((error) => void refuse(error));
      if (!found) return;
      listed = found.programs;
      drawList();
      void newestProject(get("project")).then(
        (project) => {
          if (!project) return;
          differing = project.differs;
          drawList();
        },
        () => {},
      ); // without it nothing is marked
    }

    function drawList() {
      fill(
        items,
        ...listed.map((each) =>
          h(
            "button.key.item",
            {
              type: "button",
              role: "option",
              data: { name: each.name },
              attr: { "aria-selected": String(each.name === name) },
              onclick: () => choose(each.name),
            },
            h("span.name", {}, each.name),
            h("span.program-state", {}),
            h(
              "span.program-differs",
              { title: t(TEXTS.differsText) },
              differing.includes(each.name) ? t(TEXTS.differs) : "",
            ),
            h("span.quiet.number", {}, each.bytes ? t(TEXTS.bytes, { used: each.used }) : t(TEXTS.nomemory)),
          ),
        ),
      );
      drawStates();
    }

    function drawStates() {
      for (const item of items.children) {
        const state = states.get(/** @type {HTMLElement} */ (item).dataset.name ?? "");
        const shown = item.querySelector(".program-state");
        if (shown) setText(shown, state && state.state !== HALTED ? `\u25b6 ${stateText(state)}` : "");
        item.classList.toggle("is-running", state !== undefined && state.state !== HALTED);
      }
      const state = states.get(name);
      setText(
        title,
        name
          ? [name, state ? stateText(state) : "", state?.line ? t("programs.line", { line: state.line }) : ""]
              .filter(Boolean)
              .join(" \u00b7 ")
          : t(TEXTS.choose),
      );
      listing.mark(state?.line ? lines.findIndex((each) => each.number === state.line) + 1 : 0, true);
      drawKeys(state);
    }

    /** @param {string} chosen */
    async function choose(chosen) {
      if (chosen !== name && !(await mayDrop())) return;
      if (chosen !== name) take([]); // the text of another program is never edited under this name
      isRead = false;
      name = chosen;
      chosenProgram.set(name);
      edit(false);
      for (const item of items.children)
        item.setAttribute("aria-selected", String(/** @type {HTMLElement} */ (item).dataset.name === name));
      await readText();
    }

    async function readText() {
      const found = await newest(get("card/listing", which())).catch((error) => void refuse(error));
      if (!found) return;
      isRead = true;
      take(found.lines);
      drawStates();
    }

    /** @param {{ number: number, text: string }[]} read */
    function take(read) {
      lines = read;
      listing.forget();
      listing.setTotal(lines.length);
    }

    let drawn = "";
    /** @param {State | undefined} state */
    function drawKeys(state) {
      const owner = listed.find((each) => each.name === name)?.owner ?? "";
      const isPlc = name.startsWith("PLC");
      const looks = JSON.stringify([
        name,
        isRead,
        lines.length > 0,
        state?.state === HALTED,
        state?.state === "paused",
        state?.block,
        text.hidden,
        listened,
        owner,
        model.may("service"),
      ]);
      if (looks === drawn || !name) return;
      drawn = looks;
      const bar = owner || (model.may("service") ? "" : t("role.needed", { role: t("role.service") }));
      const [isRunning, isPaused] = [state !== undefined && state.state !== HALTED, state?.state === "paused"];
      const key = (/** @type {any} */ label, /** @type {() => void} */ does, more = {}) =>
        keyOf(label, does, "", { disabled: Boolean(bar), title: bar, ...more });
      const order =
        (/** @type {string} */ cmd, values = {}) =>
        () =>
          void give(cmd, { ...which(), ...values });
      if (!text.hidden)
        fill(
          keys,
          key(TEXTS.send, () => send(), { className: "key main", disabled: false }),
          keyOf("form.drop", () => drop()),
        );
      else
        fill(
          keys,
          key(TEXTS.run, () => run(), {
            className: bar || isRunning ? "key" : "key danger",
            disabled: Boolean(bar) || isRunning,
            ...shortcut("run", "Alt+R", bar),
          }),
          key(TEXTS.halt, order("card.halt")),
          ...(isPlc
            ? []
            : [
                key(TEXTS.pause, order("card.pause"), { disabled: Boolean(bar) || !isRunning || isPaused }),
                key(TEXTS.resume, order("card.resume"), { disabled: Boolean(bar) || !isPaused }),
                key(TEXTS.block, order("card.block", { on: !state?.block }), {
                  ariaPressed: String(Boolean(state?.block)),
                }),
                key(TEXTS.step, order("card.step"), {
                  disabled: Boolean(bar) || !state?.block,
                  ...shortcut("step", "Alt+S", bar),
                }),
                key(TEXTS.listen, () => listen(), {
                  ariaPressed: String(listened === name),
                  disabled: false,
                  title: "",
                }),
              ]),
          key(TEXTS.edit, () => edit(true), { disabled: Boolean(bar) || isRunning || !isRead }),
          key(TEXTS.clear, () => clear(), { disabled: Boolean(bar) || isRunning || !lines.length }),
        );
      if (bar) keys.append(h("p.hint", {}, bar));
    }

    async function run() {
      if (!(await confirm(t(TEXTS.runTitle, { name }), t(TEXTS.runText), t(TEXTS.run)))) return;
      await give("card.run", which());
    }

    async function clear() {
      if (!(await confirm(t(TEXTS.clearTitle, { name }), t(TEXTS.clearText), t(TEXTS.clear), "bad"))) return;
      const cleared = name;
      if (await give("card.clear", which())) report(t(TEXTS.cleared, { name: cleared }));
      await readText();
    }

    /** @param {boolean} on */
    function edit(on) {
      text.hidden = !on;
      place.hidden = on;
      if (on) {
        text.value = textOf(lines);
        text.focus();
      }
      drawStates();
    }

    async function drop() {
      if (await mayDrop()) edit(false);
    }

    async function send() {
      const sent = name;
      const done = await give("card.send", { ...which(), text: text.value });
      if (!done) return false;
      report(t(TEXTS.sent, { name: sent, count: done.sent }));
      if (sent === name) edit(false);
      await readText();
      return true;
    }

    async function listen() {
      const program = which();
      const isOn = listened === name;
      if (listened) await give("card.unlisten", { program: Number(listened.slice(4)) });
      listened = "";
      if (!isOn && (await give("card.listen", program))) {
        listened = name;
        printed.replaceChildren();
      }
      printed.hidden = !listened;
      drawStates();
    }

    endings.add(
      needPrograms(),
      model.programs.watch((event) => {
        states = new Map(event.programs.map((/** @type {State} */ each) => [each.name, each]));
        drawStates();
      }),
      model.texts.watch((stored) => {
        if (!stored) return;
        void readList();
        if (["", name].includes(stored.name) && text.hidden) void readText();
      }),
      model.listened.watch((heard) => {
        if (!heard || `PROG${heard.program}` !== listened) return;
        printed.append(heard.text.replaceAll("\r", ""));
        while (printed.childNodes.length > 400) printed.firstChild?.remove();
        printed.scrollTop = printed.scrollHeight;
      }),
      () => {
        if (listened && link.isOpen.value)
          void link.command("card.unlisten", { program: Number(listened.slice(4)) }).catch(() => {});
      },
    );
    await readList();
    await choose(args.name ?? firstProgram(listed));
    /** @type {HTMLElement | null} */ (items.querySelector("[aria-selected=true]"))?.focus();
  },
};

/**
 * How a key is found by a shortcut of the bench, and that it has one.
 * @param {string} does
 * @param {string} keys
 * @param {string} bar why it cannot be pressed
 */
function shortcut(does, keys, bar) {
  return { data: { does }, title: bar || (document.querySelector(".bench") ? keys : "") };
}

/** @param {State} state */
export function stateText(state) {
  return textOr(`programs.state.${state.state}`, state.state);
}

/**
 * The text as it is edited: numbered lines with their numbers, free-form text without.
 * @param {{ number: number, text: string }[]} lines
 */
export function textOf(lines) {
  const isFree = /^\s*PROGRAM\b/i.test(lines[0]?.text ?? "");
  return lines.map((each) => (isFree ? each.text : `${each.number} ${each.text}`)).join("\n");
}
