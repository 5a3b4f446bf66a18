// Several forms as tabs of one screen.
import { get } from "../core/api.js";
import { fill, h } from "../core/dom.js";
import { loadSettingTexts, settingText } from "../core/settings_texts.js";
import { Endings } from "../core/signal.js";
import { showForm } from "./form.js";

/**
 * @typedef {object} Page a tab that is no form
 * @property {string} name
 * @property {string} title
 * @property {string} before name of the form it comes before
 * @property {(host: HTMLElement, endings: Endings) => () => boolean | Promise<boolean>} show
 */

/**
 * @param {import("./screen_host.js").Place} place
 * @param {(form: { name: string, title: string, section: string, role: string }) => boolean} isMeant
 * @param {Page[]} [pages]
 */
export async function showFormTabs({ body, endings, beforeClose }, isMeant, pages = []) {
  const [{ forms }] = await Promise.all([get("forms"), loadSettingTexts()]);
  const mine = forms
    .filter(isMeant)
    .flatMap((/** @type {any} */ form) => [...pages.filter((page) => page.before === form.name), form]);
  const list = h("div.form-tabs.scroll", { role: "tablist", attr: { "aria-orientation": "vertical" } });
  const host = h("div.form-host", { role: "tabpanel", tabIndex: -1 });
  body.classList.add("is-tabbed");
  body.append(list, host);
  const own = new Endings();
  endings.add(() => own.end());
  /** @type {() => boolean | Promise<boolean>} */
  let mayLeave = () => true;
  beforeClose(() => mayLeave());

  /** @param {string} name */
  async function choose(name) {
    if (!(await mayLeave())) return;
    own.end();
    host.className = "form-host";
    fill(host);
    for (const key of list.querySelectorAll("button")) {
      const isChosen = key.dataset.form === name;
      key.ariaSelected = String(isChosen);
      key.tabIndex = isChosen ? 0 : -1;
    }
    const page = pages.find((each) => each.name === name);
    mayLeave = page ? page.show(host, own) : showForm(host, name, own);
  }
  list.append(
    ...mine.map((/** @type {any} */ form) =>
      h(
        "button.key.item",
        { type: "button", role: "tab", data: { form: form.name }, onclick: () => choose(form.name) },
        settingText(form.title),
      ),
    ),
  );
  list.addEventListener("keydown", (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    const keys = [...list.querySelectorAll("button")];
    const next = step
      ? keys[(keys.indexOf(/** @type {any} */ (document.activeElement)) + step + keys.length) % keys.length]
      : null;
    if (!next) return;
    event.preventDefault();
    next.click();
    next.focus();
  });
  if (mine.length) await choose(mine[0].name);
}
