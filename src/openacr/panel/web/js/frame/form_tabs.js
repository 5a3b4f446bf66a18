// Several forms as tabs of one screen.
import { get } from "../core/api.js";
import { fill, h } from "../core/dom.js";
import { Endings } from "../core/signal.js";
import { showForm } from "./form.js";

/**
 * @param {import("./screen_host.js").Place} place
 * @param {(form: { name: string, title: string, section: string, role: string }) => boolean} isMeant
 * @param {Record<string, (host: HTMLElement, endings: Endings) => () => boolean | Promise<boolean>>} [others] forms with a page of their own
 */
export async function showFormTabs({ body, endings, beforeClose }, isMeant, others = {}) {
  const { forms } = await get("forms");
  const mine = forms.filter(isMeant);
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
    mayLeave = others[name]?.(host, own) ?? showForm(host, name, own);
  }
  list.append(...mine.map((/** @type {any} */ form) =>
    h("button.key.item", { type: "button", role: "tab", data: { form: form.name }, onclick: () => choose(form.name) }, form.title)));
  list.addEventListener("keydown", (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    const keys = [...list.querySelectorAll("button")];
    const next = step ? keys[(keys.indexOf(/** @type {any} */ (document.activeElement)) + step + keys.length) % keys.length] : null;
    if (!next) return;
    event.preventDefault();
    next.click();
    next.focus();
  });
  if (mine.length) await choose(mine[0].name);
}
