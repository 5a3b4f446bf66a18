// Parameters and flags of the card as a tree that can be searched; the card is asked for the values of rows that can be
// seen.
import { get, latest } from "../../core/api.js";
import { refuse } from "../../core/app.js";
import { fill, h, setText } from "../../core/dom.js";
import { Endings } from "../../core/signal.js";
import { t } from "../../core/texts.js";
import { LiveItems, changeValue } from "../../frame/card_value.js";
import { showFacts } from "../facts.js";
import { takeWanted } from "../wanted.js";
import { addToWatchList } from "../watch_list.js";

const TEXTS = {
  search: { en: "Words of a name, or a number", de: "W\u00f6rter eines Namens, oder eine Nummer" },
  card: { en: "Card", de: "Karte" },
};

const [ROW_PX, SPARE, SETTLE_MS] = [32, 4, 120];
const PAGE = 500; // rows of one request
const NO_OBJECT = "none";

/**
 * @typedef {import("../../frame/card_value.js").Item} Item
 * @typedef {{ object: string, index: number | null, parameters: number, flags: number }} Group
 * @typedef {{ key: string, level: number, text: string, count?: number, group?: Group, item?: Item,
 *   value?: HTMLElement }} Row
 */

/**
 * @param {HTMLElement} host
 * @param {import("../panes.js").Place} place
 */
export async function mount(host, { head }) {
  const endings = new Endings();
  const live = new LiveItems(update); // of the rows that are seen
  const field = h("input.field.grow", { type: "search", placeholder: t(TEXTS.search), ariaLabel: t(TEXTS.search) });
  const space = h("div.tree-space", {});
  const box = h("div.tree.grow", { role: "tree", tabIndex: 0, ariaLabel: t("pane.tree") }, space);
  const facts = h("div.tree-facts", { role: "status" });
  head.append(field);
  host.append(box, facts);
  /** @type {Group[]} */
  let groups = [];
  /** @type {Map<string, Item[]>} */
  let items = new Map();
  /** @type {Set<string>} */
  let open = new Set();
  /** @type {Row[]} */
  let rows = [];
  let current = 0;
  const newest = latest(endings);

  async function search() {
    const found = await newest(get("card/groups", { text: field.value.trim() || undefined })).catch(
      (error) => void refuse(error),
    );
    if (!found) return;
    groups = found.groups;
    items = new Map();
    open = new Set();
    current = 0;
    box.scrollTop = 0;
    list();
    if (field.value.trim() && groups.length) await show(groups[0]);
  }

  /** Open the first group that a search has found. @param {Group} group */
  async function show(group) {
    open.add(group.object);
    await unfold(group);
  }

  /** Make the list of rows from what is open. */
  function list() {
    const objects = [...new Set(groups.map((group) => group.object))].sort();
    rows = objects.flatMap((object) => {
      const own = groups.filter((group) => group.object === object);
      const name = object === NO_OBJECT ? t(TEXTS.card) : object;
      const count = own.reduce((sum, each) => sum + each.parameters + each.flags, 0);
      const single = own.length === 1 && own[0].index === null ? own[0] : undefined;
      const node = { key: object, level: 1, text: name, count, group: single };
      if (!open.has(object)) return [node];
      return [
        node,
        ...(single
          ? leaves(single, 2)
          : own.flatMap((group) => {
              const key = keyOf(group);
              const branch = {
                key,
                level: 2,
                text: `${name}${group.index ?? ""}`,
                count: group.parameters + group.flags,
                group,
              };
              return open.has(key) ? [branch, ...leaves(group, 3)] : [branch];
            })),
      ];
    });
    space.style.height = `${rows.length * ROW_PX}px`;
    current = Math.min(current, Math.max(0, rows.length - 1));
    draw();
  }

  /**
   * @param {Group} group
   * @param {number} level
   * @returns {Row[]}
   */
  function leaves(group, level) {
    return (items.get(keyOf(group)) ?? []).map((item) => ({ key: item.id, level, text: item.name, item }));
  }

  /** Draw the rows that can be seen, and ask for their values. */
  function draw() {
    const first = Math.max(0, Math.floor(box.scrollTop / ROW_PX) - SPARE);
    const shown = rows.slice(first, first + Math.ceil(box.clientHeight / ROW_PX) + 2 * SPARE);
    fill(space, ...shown.map((row, n) => elementOf(row, first + n)));
    box.setAttribute("aria-activedescendant", rows[current] ? `${host.id || "tree"}-${current}` : "");
    update();
    const item = rows[current]?.item;
    showFacts(facts, item, () => (item ? live.text(item) : ""));
    clearTimeout(timer);
    timer = setTimeout(() => live.need(shown.flatMap((row) => row.item ?? [])), SETTLE_MS);
  }
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;

  function update() {
    for (const row of rows) if (row.item && row.value?.isConnected) setText(row.value, live.text(row.item));
  }

  /**
   * @param {Row} row
   * @param {number} place
   */
  function elementOf(row, place) {
    row.value = row.item ? h("strong.live.tree-value", {}) : undefined;
    const isOpen = open.has(row.key);
    const element = h(
      "div.tree-row",
      {
        id: `${host.id || "tree"}-${place}`,
        role: "treeitem",
        data: row.item ? { key: row.key, item: row.item.id } : { key: row.key },
        onclick: () => choose(place, true),
        ondblclick: () => act(),
        attr: {
          "aria-level": row.level,
          "aria-expanded": row.item ? null : String(isOpen),
          "aria-selected": String(place === current),
        },
      },
      h("span.tree-sign", { ariaHidden: "true" }, row.item ? "" : isOpen ? "\u25be" : "\u25b8"),
      row.item ? h("span.quiet.tree-id", {}, row.item.id) : "",
      h("span.tree-name", {}, row.text),
      row.value ?? h("span.quiet", {}, String(row.count)),
      row.item?.unit ? h("span.quiet", {}, row.item.unit) : "",
    );
    element.style.top = `${place * ROW_PX}px`;
    element.style.paddingLeft = `${row.level * 14 - 6}px`;
    return element;
  }

  /**
   * @param {number} place
   * @param {boolean} [isPressed]
   */
  function choose(place, isPressed = false) {
    current = Math.min(rows.length - 1, Math.max(0, place));
    const top = current * ROW_PX;
    if (top < box.scrollTop) box.scrollTop = top;
    else if (top + ROW_PX > box.scrollTop + box.clientHeight) box.scrollTop = top + ROW_PX - box.clientHeight;
    if (isPressed && rows[current] && !rows[current].item) void toggle(rows[current]);
    else draw();
  }

  /** @param {Row} row */
  async function toggle(row) {
    if (open.delete(row.key)) list();
    else if (row.group) await unfold(row.group, row.key);
    else {
      open.add(row.key);
      list();
    }
  }

  /**
   * @param {Group} group
   * @param {string} [key] of the row that shows it
   */
  async function unfold(group, key = keyOf(group)) {
    const searched = groups;
    const query = { object: group.object, index: group.index ?? undefined, text: field.value.trim() || undefined };
    if (!items.has(keyOf(group))) {
      const found = await Promise.all([
        all("parameters", group.parameters, query),
        all("flags", group.flags, query),
      ]).catch((error) => void refuse(error));
      if (!found || searched !== groups) return; // found by another search
      items.set(keyOf(group), found.flat());
    }
    open.add(key);
    list();
  }

  function act() {
    const item = rows[current]?.item;
    if (item?.writable) void changeValue(item, live.text(item));
  }

  /** @type {Record<string, () => void>} */
  const keys = {
    ArrowDown: () => choose(current + 1),
    ArrowUp: () => choose(current - 1),
    Home: () => choose(0),
    End: () => choose(rows.length - 1),
    PageDown: () => choose(current + 10),
    PageUp: () => choose(current - 10),
    ArrowRight: () =>
      rows[current] && !rows[current].item && !open.has(rows[current].key) && void toggle(rows[current]),
    ArrowLeft: () => {
      if (open.has(rows[current]?.key)) void toggle(rows[current]);
      else
        choose(
          rows
            .slice(0, current)
            .map((row) => row.level < rows[current].level)
            .lastIndexOf(true),
        );
    },
    Enter: () => (rows[current]?.item ? act() : rows[current] && void toggle(rows[current])),
    Insert: () => rows[current]?.item && addToWatchList(rows[current].key),
  };
  box.addEventListener("keydown", (event) => {
    if (!(event.key in keys)) return;
    event.preventDefault();
    keys[event.key]();
  });
  box.addEventListener("scroll", draw);
  const sizes = new ResizeObserver(draw);
  sizes.observe(box);
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let typing;
  field.addEventListener("input", () => {
    clearTimeout(typing);
    typing = setTimeout(search, 250);
  });
  endings.add(
    () => sizes.disconnect(),
    () => clearTimeout(timer),
    () => clearTimeout(typing),
    () => live.end(),
  );
  await search();
  endings.add(
    takeWanted("tree", ([text]) => {
      field.value = text;
      void search();
    }),
  );
  return () => endings.end();
}

/** @param {Group} group */
function keyOf(group) {
  return `${group.object}:${group.index ?? ""}`;
}

/**
 * All parameters or flags of a query, page by page.
 * @param {"parameters" | "flags"} what
 * @param {number} count
 * @param {Record<string, string | number | undefined>} query
 * @returns {Promise<Item[]>}
 */
async function all(what, count, query) {
  const pages = Array.from({ length: Math.ceil(count / PAGE) }, (_each, n) =>
    get(`card/${what}`, { ...query, first: n * PAGE, count: PAGE }),
  );
  return (await Promise.all(pages)).flatMap((page) => page[what]);
}
