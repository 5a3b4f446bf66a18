// MEMORY CONFIG: the bytes of the card for each program and PLC program.
import { give, link, refuse, report } from "../core/app.js";
import { fill, h, setText } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { CommandError } from "../core/link.js";
import { t } from "../core/texts.js";
import { confirm } from "../frame/dialog.js";

const TEXTS = {
  title: { en: "Memory configuration", de: "Speicheraufteilung" },
  warning: {
    en: "Only experienced personnel. A change loses all programs, PLC programs and variables on the card.",
    de: "Nur für erfahrenes Personal. Eine Änderung löscht alle Programme, SPS-Programme und Variablen der Karte.",
  },
  save: { en: "SAVE AND CLEAR THE CARD", de: "SPEICHERN UND KARTE LÖSCHEN" },
  lost: {
    en: "All programs, PLC programs and variables that are stored on the card are lost. The machine is set up again.",
    de: "Alle Programme, SPS-Programme und Variablen auf der Karte gehen verloren. Die Maschine wird neu eingerichtet.",
  },
  bytes: { en: "bytes", de: "Byte" },
  free: { en: "Free: {free} bytes", de: "Frei: {free} Byte" },
  number: { en: "{name}: a whole number of bytes", de: "{name}: eine ganze Zahl von Byte" },
  done: { en: "The memory of the card is divided anew", de: "Der Speicher der Karte ist neu aufgeteilt" },
};

const AGAIN_MS = 1000;

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: TEXTS.title,
  area: "full",
  async show({ body, endings, beforeClose }) {
    const rows = h("div.memory-rows.grow.scroll", {});
    const free = h("strong.grow", { role: "status" });
    const saveKey = keyOf(TEXTS.save, save, ".danger", { disabled: true });
    body.append(h("div.notice", {}, t(TEXTS.warning)), rows, h("div.row", {}, free, saveKey));
    /** @type {{ name: string, input: HTMLInputElement, before: string }[]} */
    let fields = [];
    const changed = () => fields.filter(({ input, before }) => input.value.trim() !== before);

    /** @param {{ sizes: Record<string, number>, free: number }} division */
    function draw(division) {
      fields = Object.entries(division.sizes).map(([name, size]) => ({
        name,
        before: String(size),
        input: h("input.field.number", {
          id: `memory-${name}`,
          value: String(size),
          inputMode: "numeric",
          autocomplete: "off",
          oninput: follow,
        }),
      }));
      fill(
        rows,
        ...fields.map(({ name, input }) =>
          h("div.memory-row", {}, h("label", { htmlFor: input.id }, name), input, h("span.unit", {}, t(TEXTS.bytes))),
        ),
      );
      setText(free, t(TEXTS.free, { free: division.free }));
      follow();
    }
    function follow() {
      for (const { input, before } of fields) input.classList.toggle("is-changed", input.value.trim() !== before);
      saveKey.disabled = !changed().length;
    }
    async function read() {
      try {
        draw(await link.command("memory.read"));
      } catch (error) {
        if (!(error instanceof CommandError)) throw error;
        refuse(error);
      }
    }
    async function save() {
      const wrong = changed().find(({ input }) => !/^\d+$/.test(input.value.trim()));
      if (wrong) {
        refuse(t(TEXTS.number, { name: wrong.name }));
        wrong.input.focus();
        return;
      }
      if (!(await confirm(t(TEXTS.title), t(TEXTS.lost), t(TEXTS.save)))) return;
      const sizes = Object.fromEntries(changed().map(({ name, input }) => [name, Number(input.value)]));
      const division = await give("memory.set", { sizes, confirm: true });
      if (!division) return;
      draw(division);
      report(t(TEXTS.done));
    }
    beforeClose(
      async () =>
        !changed().length ||
        confirm(t("form.leave"), t("form.leave.text", { count: changed().length }), t("form.drop")),
    );
    await read();
    const timer = setInterval(() => fields.length || void read(), AGAIN_MS); // it is shown at rest only
    endings.add(() => clearInterval(timer));
  },
};
