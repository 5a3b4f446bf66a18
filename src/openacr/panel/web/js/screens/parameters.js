// SYS PARAM: the tabs of the parameters of the machine, with a search over all of them.
import { get, latest } from "../core/api.js";
import { fill, h } from "../core/dom.js";
import { searchedTexts, settingText } from "../core/settings_texts.js";
import { t } from "../core/texts.js";
import { showFormTabs } from "../frame/form_tabs.js";

const TEXTS = {
  search: { en: "Find a parameter", de: "Parameter suchen" },
  nothing: { en: "Nothing found", de: "Nichts gefunden" },
};

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "System parameters", de: "Systemparameter" },
  area: "full",
  async show(place) {
    const found = h("div.search-results.list", { hidden: true });
    const field = h("input.field", {
      type: "search",
      placeholder: t(TEXTS.search),
      ariaLabel: t(TEXTS.search),
      oninput: () => void search(),
    });
    place.head.append(h("div.search", {}, field, found));
    const newest = latest(place.endings);
    const search = async () => {
      const text = field.value.trim();
      found.hidden = text.length < 2;
      if (found.hidden) return;
      const asked = searchedTexts(text).map((each) => get("settings/search", { text: each }));
      const answers = await newest(Promise.all(asked)).catch(() => []);
      if (!answers) return;
      const all = answers.flatMap((each) => each.cells);
      const cells = [...new Map(all.map((/** @type {any} */ each) => [each.number, each])).values()];
      fill(found, ...(cells.length ? cells.slice(0, 30).map(rowOf) : [h("p.hint", {}, t(TEXTS.nothing))]));
    };
    const rowOf = (/** @type {any} */ cell) =>
      h(
        "button.key.item",
        {
          type: "button",
          onclick: () => {
            found.hidden = true;
            /** @type {HTMLElement | null} */ (place.body.querySelector(`[data-form="${cell.form}"]`))?.click();
          },
        },
        h("span.name", { title: cell.name }, settingText(cell.name)),
        h("span.quiet", {}, `${cell.form}  P${cell.number}`),
      );
    await showFormTabs(place, (form) => form.section === "SYS PARAM");
  },
};
