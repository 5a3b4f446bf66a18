// SETUP SCREEN: which blocks each of the three views shows.
import { get, send } from "../core/api.js";
import { model, refuse, report } from "../core/app.js";
import { h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { BLOCK_NAMES } from "../blocks/blocks.js";

const TEXTS = {
  block: { en: "Block", de: "Block" },
  save: { en: "SAVE VIEW", de: "ANSICHT SPEICHERN" },
  saved: { en: "The views are saved", de: "Die Ansichten sind gespeichert" },
};

const VIEWS = [0, 1, 2];

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "Setup screen", de: "Ansichten" },
  async show({ body }) {
    const form = await get("forms/VIEWS");
    const rows = form.groups.flatMap((/** @type {any} */ group) => group.rows);
    const shown = VIEWS.map((n) => String(rows[n].value).split(/\s+/));
    const boxes = BLOCK_NAMES.map((name) => ({
      name,
      cells: VIEWS.map((n) =>
        h("input", {
          type: "checkbox",
          checked: shown[n].includes(name),
          ariaLabel: `${t(/** @type {any} */ (`block.${name}`))}, ${t("status.view", { n: n + 1 })}`,
        }),
      ),
    }));
    const save = async () => {
      const chosen = VIEWS.map((n) => [
        String(rows[n].number),
        boxes
          .filter(({ cells }) => cells[n].checked)
          .map(({ name }) => name)
          .join(" "),
      ]);
      try {
        await send("PUT", "forms/VIEWS", { values: Object.fromEntries(chosen) });
        report(t(TEXTS.saved));
        model.changed.set({ what: "forms", cells: VIEWS.map((n) => rows[n].number) });
      } catch (error) {
        refuse(error);
      }
    };
    body.append(
      h(
        "table.grid",
        {},
        h(
          "thead",
          {},
          h("tr", {}, h("th", {}, t(TEXTS.block)), ...VIEWS.map((n) => h("th", {}, t("status.view", { n: n + 1 })))),
        ),
        h(
          "tbody",
          {},
          ...boxes.map(({ name, cells }) =>
            h(
              "tr",
              {},
              h("td", {}, t(/** @type {any} */ (`block.${name}`))),
              ...cells.map((cell) => h("td", {}, h("label.check", {}, cell))),
            ),
          ),
        ),
      ),
      h("div.row", {}, h("span.grow", {}), keyOf(TEXTS.save, save, ".main")),
    );
  },
};
