// Screens that show groups of named values of the card, read again while they are open.
import { get } from "../core/api.js";
import { refuse } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";

const EVERY_MS = 500;

/**
 * @typedef {{ title: string, rows: { name: string, value: string | number, unit?: string, parameter?: number | null, share?: number }[] }} Group
 *
 * @param {string} place of the server
 * @param {import("../core/texts.js").TextKey} title
 * @returns {import("./screen_host.js").Screen}
 */
export function factsScreen(place, title) {
  return {
    title,
    area: "full",
    async show({ body, endings }) {
      const [warning, groups] = [h("div.notice", {}, t("diag.warning")), h("div.fact-groups", {})];
      body.append(warning, groups);
      const draw = async () => {
        try {
          const answer = await get(place);
          if (answer.warning) fill(warning, answer.warning);
          fill(groups, ...answer.groups.map(groupOf));
        } catch (error) {
          refuse(error);
        }
      };
      await draw();
      const timer = setInterval(draw, EVERY_MS);
      endings.add(() => clearInterval(timer));
    },
  };
}

/** @param {Group} group */
export function groupOf(group) {
  return h("section.fact-group", {}, group.title ? h("h3", {}, group.title) : "", h("table.grid", {}, h("tbody", {}, ...group.rows.map((row) =>
    h("tr", {}, h("td", {}, row.name), h("td.quiet.number", {}, row.parameter ? `P${row.parameter}` : ""),
      h("td.number", {}, h("strong", {}, String(row.value)), row.unit ? ` ${row.unit}` : ""),
      row.unit === "%" ? h("td", {}, h("meter", { min: 0, max: 100, value: Number(row.value) || 0, ariaLabel: row.name })) : "")))));
}
