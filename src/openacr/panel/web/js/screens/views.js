// SETUP SCREEN: which blocks each of the three views shows.
import { get, send } from "../core/api.js";
import { model, refuse, report } from "../core/app.js";
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { BLOCK_NAMES } from "../blocks/blocks.js";

const VIEWS = ["view1", "view2", "view3"];

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "views.title",
  async show({ body }) {
    const views = await get("views").catch(() => ({}));
    const boxes = BLOCK_NAMES.map((name) => ({ name, cells: VIEWS.map((view) => h("input", { type: "checkbox", checked: (views[view] ?? []).includes(name), ariaLabel: `${t(/** @type {any} */ (`block.${name}`))} ${view}` })) }));
    const save = async () => {
      const chosen = Object.fromEntries(VIEWS.map((view, n) => [view, boxes.filter(({ cells }) => cells[n].checked).map(({ name }) => name)]));
      try {
        await send("PUT", "views", chosen);
        report(t("views.saved"));
        model.changed.set({ what: "views", cells: [] });
      } catch (error) {
        refuse(error);
      }
    };
    body.append(h("table.grid", {}, h("thead", {}, h("tr", {}, h("th", {}, t("views.block")), ...VIEWS.map((_view, n) => h("th", {}, t("status.view", { n: n + 1 }))))),
      h("tbody", {}, ...boxes.map(({ name, cells }) => h("tr", {}, h("td", {}, t(/** @type {any} */ (`block.${name}`))), ...cells.map((cell) => h("td", {}, h("label.check", {}, cell))))))),
    h("div.row", {}, h("span.grow", {}), h("button.key.main", { type: "button", onclick: save }, t("views.save"))));
  },
};
