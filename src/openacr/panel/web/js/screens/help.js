// HELP: a page for every key of every menu.
import { get, latest } from "../core/api.js";
import { fill, h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { MENUS } from "../frame/menus.js";
import { closeScreen } from "../frame/screen_host.js";

const TEXTS = { none: { en: "There is no page on this key.", de: "Zu dieser Taste gibt es keine Seite." } };

/** Keys that are explained on a page of the server with others. @type {Record<string, string>} */
const PAGES = {
  main: "",
  diag: "setdiag",
  parameters: "setdiag",
  clearZero: "clrzero",
  zero: "setzero",
  gotoZero: "gotozero",
  start: "run",
  runLine: "run",
  dryRun: "run",
  block: "run",
  abort: "stop",
  resume: "stop",
  traceBack: "stop",
  traceStop: "stop",
  traceForward: "stop",
  buttons: "display",
  ionames: "display",
  resize: "display",
  messages: "display",
  views: "display",
};

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "Help", de: "Hilfe" },
  help: { en: "A page on every key: choose it on the left.", de: "Eine Seite zu jeder Taste: links wählen." },
  area: "full",
  show({ body, head, endings }) {
    const newest = latest(endings);
    const text = h("article.help-text.scroll", { tabIndex: 0 });
    const list = h("div.form-tabs.scroll", {});
    body.classList.add("is-tabbed");
    body.append(list, text);
    head.append(
      keyOf("tour.title", async () => {
        await closeScreen();
        (await import("../tour/tour.js")).startTour();
      }),
    );
    const show = async (/** @type {HTMLElement} */ item, /** @type {import("../frame/menus.js").MenuKey} */ entry) => {
      for (const each of list.children) each.setAttribute("aria-current", String(each === item));
      const page = await newest(pageOf(entry)).catch(() => ({ title: t(entry.label), text: t(TEXTS.none) }));
      if (page)
        fill(
          text,
          h("h2", {}, page.title),
          ...page.text.split(/\n\s*\n/).map((/** @type {string} */ part) => h("p", {}, part)),
        );
    };
    const seen = new Set();
    for (const [menu, keys] of Object.entries(MENUS)) {
      for (const entry of keys) {
        if (!nameOf(entry) || seen.has(entry.label)) continue;
        seen.add(entry.label);
        const item = h(
          "button.key.item",
          { type: "button", onclick: () => show(item, entry) },
          h("span.name", {}, t(entry.label)),
          h("span.quiet", { title: menu }, `F${entry.key}`),
        );
        list.append(item);
      }
    }
    list.querySelector("button")?.click();
  },
};

/**
 * The page on a key: that of its screen, else one of the server.
 * @param {import("../frame/menus.js").MenuKey} entry
 * @returns {Promise<{ title: string, text: string }>}
 */
async function pageOf(entry) {
  const help = entry.screen && (await import(`./${entry.screen}.js`)).screen.help;
  return help
    ? { title: t(entry.label), text: t(help) }
    : get(`help/${nameOf(entry)}`, { language: document.documentElement.lang });
}

/** @param {import("../frame/menus.js").MenuKey} entry */
function nameOf(entry) {
  const name = entry.menu ?? entry.args?.form?.toLowerCase() ?? entry.screen ?? entry.action ?? "";
  return PAGES[name] ?? name;
}
