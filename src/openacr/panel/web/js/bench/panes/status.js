// Status: one of the panels that the server declares, objects side by side; a chosen value can be watched and changed.
import { get, latest } from "../../core/api.js";
import { refuse } from "../../core/app.js";
import { cardAxes } from "../../core/card_axes.js";
import { fill, h, setText } from "../../core/dom.js";
import { Endings } from "../../core/signal.js";
import { t, textOr } from "../../core/texts.js";
import { LiveItems, isFlag } from "../../frame/card_value.js";
import { showFacts } from "../facts.js";

const TEXTS = {
  which: { en: "What is shown", de: "Was gezeigt wird" },
  objects: { en: "Which of them", de: "Welche davon" },
};

const FIRST = 4; // objects that are shown at first where the machine does not say which

/**
 * @typedef {import("../../frame/card_value.js").Item} Item
 * @typedef {{ objects: string[], groups: { title: string, rows: { name: string, items: (Item | null)[] }[] }[] }} Panel
 * @typedef {{ item: Item, value: HTMLElement }} Cell
 */

/**
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head, kept, keep }) {
  const endings = new Endings();
  const live = new LiveItems(update);
  const choice = h("select.field", { ariaLabel: t(TEXTS.which), onchange: () => choose(choice.value) });
  const objects = h("div.row.scroll.grow", { role: "group", ariaLabel: t(TEXTS.objects) });
  const table = h("table.grid.status-table", {});
  head.append(choice, objects);
  const facts = h("div.tree-facts", { role: "status" });
  host.append(h("div.grow.scroll", { tabIndex: 0 }, table), facts);
  let name = String(kept.panel ?? "");
  /** @type {Record<string, string[]>} */
  let chosen = kept.objects ?? {};
  /** @type {Cell[]} */
  let cells = [];
  const newest = latest(endings);
  const named = new Map((await cardAxes()).map((axis) => [`AXIS${axis.index}`, nameOf(axis)]));

  /** An object, an axis with its letter. @param {string} object */
  function titleOf(object) {
    return named.has(object) ? `${object} ${named.get(object)}` : object;
  }

  /** @param {string} wanted */
  async function choose(wanted) {
    /** @type {Panel | undefined} */
    const panel = await newest(get("card/panel", { name: wanted })).catch((error) => void refuse(error));
    if (!panel) return;
    name = wanted;
    choice.value = name;
    draw(panel);
  }

  /** @param {Panel} panel */
  function draw(panel) {
    const shown = (chosen[name] ?? atFirst(panel.objects, named)).filter((each) => panel.objects.includes(each));
    keep({ panel: name, objects: chosen });
    fill(
      objects,
      ...(panel.objects.length > 1 ? panel.objects : []).map((object) =>
        h(
          "button.key",
          {
            type: "button",
            title: titleOf(object),
            ariaPressed: String(shown.includes(object)),
            onclick: () => {
              chosen = {
                ...chosen,
                [name]: panel.objects.filter((each) => (each === object) !== shown.includes(each)),
              };
              draw(panel);
            },
          },
          named.get(object) ?? (object.replace(/^[A-Z]+(?=\d+$)/, "") || object),
        ),
      ),
    );
    cells = [];
    fill(facts);
    const places = shown.map((object) => panel.objects.indexOf(object));
    fill(
      table,
      h("thead", {}, h("tr", {}, h("th", {}, ""), ...shown.map((object) => h("th.number", {}, titleOf(object))))),
      ...panel.groups.map((group) =>
        h(
          "tbody",
          {},
          h(
            "tr",
            {},
            h("th", { colSpan: shown.length + 1, scope: "rowgroup" }, textOr(`panels.${group.title}`, group.title)),
          ),
          ...group.rows.map((row) =>
            h(
              "tr",
              {},
              h("td", { title: row.items.find(Boolean)?.doc ?? "" }, row.name, h("span.quiet", {}, unitOf(row.items))),
              ...places.map((place) => cellOf(row.items[place])),
            ),
          ),
        ),
      ),
    );
    live.need(cells.map(({ item }) => item));
  }

  /** @param {Item | null} item */
  function cellOf(item) {
    if (!item) return h("td.number", {}, "");
    const value = h("strong.live", {});
    cells.push({ item, value });
    const chosenNow = () => showFacts(facts, item, () => live.text(item));
    return h("td.number", { tabIndex: 0, data: { item: item.id }, title: item.id, onfocus: chosenNow }, value);
  }

  function update() {
    for (const { item, value } of cells) {
      const text = live.text(item);
      setText(value, text);
      if (isFlag(item)) value.classList.toggle("is-running", text === t("io.on"));
    }
  }

  endings.add(() => live.end());
  const { panels } = await get("card/panels");
  fill(
    choice,
    ...panels.map((/** @type {{ name: string, title: string }} */ each) =>
      h("option", { value: each.name }, textOr(`panels.${each.name}`, each.title)),
    ),
  );
  await choose(panels.some((/** @type {{ name: string }} */ each) => each.name === name) ? name : panels[0].name);
  return () => endings.end();
}

/**
 * The axes that have a name on the card; of other objects the first ones.
 * @param {string[]} objects
 * @param {Map<string, string>} named
 */
function atFirst(objects, named) {
  const axes = objects.filter((each) => named.has(each));
  return axes.length ? axes : objects.slice(0, FIRST);
}

/** The letter of an axis: that of the machine, or of the program that has it. @param {import("../../core/card_axes.js").CardAxis} axis */
function nameOf(axis) {
  return axis.title.replace(/ .*/, "");
}

/** @param {(Item | null)[]} items */
function unitOf(items) {
  const unit = items.find(Boolean)?.unit;
  return unit ? `  ${unit}` : "";
}
