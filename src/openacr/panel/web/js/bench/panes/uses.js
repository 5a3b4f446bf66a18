// Cross reference: every parameter, flag, alias and label of the programs on the card, who reads and who writes it.
import { get, latest } from "../../core/api.js";
import { model, refuse } from "../../core/app.js";
import { fill, h, setText } from "../../core/dom.js";
import { keyOf } from "../../core/keys.js";
import { Endings } from "../../core/signal.js";
import { t } from "../../core/texts.js";
import { fullName } from "../../frame/card_value.js";
import { takeWanted, want } from "../wanted.js";

const TEXTS = {
  find: { en: "P10, BIT516, LV0, a name or words", de: "P10, BIT516, LV0, ein Name oder W\u00f6rter" },
  read: { en: "READ", de: "LESEN" },
  none: { en: "No program on the card names it", de: "Kein Programm der Karte nennt es" },
  count: { en: "{count} {count|name|names}", de: "{count} {count|Name|Namen}" },
  more: { en: "{count} more: type a part of the name", de: "{count} weitere: einen Teil des Namens eingeben" },
  reads: { en: "reads", de: "liest" },
  writes: { en: "writes", de: "schreibt" },
  defines: { en: "defines", de: "definiert" },
  neverWritten: { en: "No program writes it", de: "Kein Programm schreibt es" },
  target: { en: "stands for {name}", de: "steht f\u00fcr {name}" },
  list: { en: "Names and their uses", de: "Namen und ihre Verwendung" },
};
/** @type {Record<string, import("../../core/texts.js").Said>} */
const ACCESS = { reads: TEXTS.reads, writes: TEXTS.writes, defines: TEXTS.defines };
const MOST = 200;

/**
 * @typedef {{ program: string, line: number, text: string, access: string }} Use
 * @typedef {{ name: string, item: import("../../frame/card_value.js").Item | null, target: string,
 *   uses: Use[] }} Name
 *
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head, kept, keep }) {
  const endings = new Endings();
  const newest = latest(endings);
  /** @type {Name[]} */
  let names = [];
  const field = h("input.field.grow", {
    value: kept.find ?? "",
    ariaLabel: t(TEXTS.find),
    placeholder: t(TEXTS.find),
    autocomplete: "off",
    spellcheck: false,
    oninput: () => draw(),
  });
  const status = h("span.hint", { role: "status" });
  head.append(
    field,
    keyOf(TEXTS.read, () => read()),
    status,
  );
  const list = h("div.grow.scroll.uses", { tabIndex: 0, role: "region", ariaLabel: t(TEXTS.list) });
  host.append(list);

  async function read() {
    const found = await newest(get("card/uses")).catch((error) => void refuse(error));
    if (!found) return;
    names = found.names;
    draw();
  }

  function draw() {
    const find = field.value.trim();
    keep({ find });
    const shown = find ? names.filter((each) => fits(each, find)) : names;
    setText(status, t(TEXTS.count, { count: shown.length }));
    fill(
      list,
      ...shown.slice(0, MOST).map(sectionOf),
      shown.length ? null : h("p.hint", {}, t(TEXTS.none)),
      shown.length > MOST ? h("p.hint", {}, t(TEXTS.more, { count: shown.length - MOST })) : null,
    );
  }

  endings.add(
    takeWanted("uses", ([name = ""]) => {
      field.value = name;
      draw();
    }),
    model.texts.watch((stored) => stored && void read()),
  );
  await read();
  return () => endings.end();
}

/**
 * A whole name or number first: P1 is not P10; else all words are in what is known of it.
 * @param {Name} name
 * @param {string} find
 */
function fits({ name, item, target }, find) {
  const exact = /^(?:PROG\d+ )?(P|BIT|[LSD$][VA])?\d+$/i.exec(find);
  const own = [name, name.replace(/^\S+ /, ""), target].map((each) => each.toUpperCase());
  if (exact) return exact[1] ? own.includes(find.toUpperCase()) : own.some((each) => each.replace(/^\D+/, "") === find);
  const known = [name, target, item ? `${fullName(item)} ${item.section}` : ""].join(" ").toUpperCase();
  return find
    .toUpperCase()
    .split(/\s+/)
    .every((word) => known.includes(word));
}

/** @param {Name} name */
function sectionOf({ name, item, target, uses }) {
  const isValue = item !== null || /(^|\s)(P|BIT|[LSD$][VA])\d+$/.test(name);
  const isWritten = uses.some(({ access }) => access === "writes");
  return h(
    "section.use",
    { data: { name } },
    h("strong", {}, name),
    " ",
    h("span", {}, item ? fullName(item) : target ? t(TEXTS.target, { name: target }) : ""),
    item ? h("p.hint", {}, [item.section, item.doc].filter(Boolean).join(" \u2014 ")) : null,
    isValue && !isWritten ? h("p.hint", {}, t(TEXTS.neverWritten)) : null,
    ...uses.map(({ program, line, text, access }) =>
      h(
        "button",
        {
          type: "button",
          className: `key item use-line is-${access}`,
          onclick: () => want("editor", program, String(line)),
        },
        h("span.number", {}, `${program} ${line}`),
        h("span.use-access", {}, t(ACCESS[access])),
        h("span.name.mono", {}, text),
      ),
    ),
  );
}
