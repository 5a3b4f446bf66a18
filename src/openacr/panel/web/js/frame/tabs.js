// A tab control: arrow keys move between tabs; only the shown panel works.
import { h } from "../core/dom.js";
import { Endings } from "../core/signal.js";

/**
 * @typedef {{ id: string, label: string, show: (panel: HTMLElement, endings: Endings) => void }} Tab
 */

/**
 * Fill a pane with tabs; returns the function that chooses one by its id.
 * @param {HTMLElement} pane
 * @param {string} label
 * @param {Tab[]} tabs
 * @param {(id: string) => void} [chosen]
 */
export function tabControl(pane, label, tabs, chosen = () => {}) {
  const endings = new Endings();
  const panel = h("div.tab-panel", { id: `${pane.id}-panel`, role: "tabpanel", tabIndex: 0 });
  const keys = tabs.map((tab) =>
    h(
      "button",
      {
        type: "button",
        role: "tab",
        id: `${pane.id}-tab-${tab.id}`,
        onclick: () => choose(tab.id),
        attr: { "aria-controls": panel.id },
      },
      tab.label,
    ),
  );
  const list = h(
    "div.tab-list",
    {
      role: "tablist",
      ariaLabel: label,
      onkeydown: (/** @type {KeyboardEvent} */ event) => {
        const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        if (!step) return;
        const next = (keys.indexOf(/** @type {any} */ (document.activeElement)) + step + keys.length) % keys.length;
        choose(tabs[next].id);
        keys[next].focus();
        event.preventDefault();
      },
    },
    ...keys,
  );
  let current = "";

  /** @param {string} id */
  function choose(id) {
    if (!id) current = ""; // the next choice is drawn anew
    if (!id) return;
    const place = Math.max(
      0,
      tabs.findIndex((tab) => tab.id === id),
    );
    if (tabs[place].id === current) return;
    current = tabs[place].id;
    keys.forEach((key, n) => {
      key.ariaSelected = String(n === place);
      key.tabIndex = n === place ? 0 : -1;
    });
    endings.end();
    panel.className = "tab-panel";
    panel.replaceChildren();
    panel.setAttribute("aria-labelledby", keys[place].id);
    tabs[place].show(panel, endings);
    chosen(current);
  }
  pane.append(list, panel);
  return choose;
}
