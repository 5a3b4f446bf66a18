// The keys above a pane in one row where the window is narrow: those that do not fit are in a menu at its end.
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { NARROW } from "./narrow.js";

const TEXTS = { more: { en: "More keys", de: "Weitere Tasten" } };
let menus = 0;

/**
 * Keep the children that a row has now in one line where the window is narrow; the last ones go into a menu first.
 * @param {HTMLElement} row
 * @returns {() => void} what ends it
 */
export function keepInOneRow(row) {
  const own = [...row.children];
  const menu = h("div.more-menu", { id: `more-${(menus += 1)}`, popover: "auto" });
  const more = h("button.key.more-key", { type: "button", ariaLabel: t(TEXTS.more), title: t(TEXTS.more) }, "\u22ef");
  more.setAttribute("popovertarget", menu.id);
  menu.addEventListener("click", ({ target }) => {
    if (target instanceof Element && target.closest("button")) menu.hidePopover();
  });
  menu.addEventListener("beforetoggle", place);
  row.append(more, menu);

  function place() {
    const { bottom, right } = more.getBoundingClientRect();
    menu.style.top = `${bottom + 2}px`;
    menu.style.right = `${Math.max(0, document.documentElement.clientWidth - right)}px`;
  }

  let fitted = ""; // what the row was when it was fitted
  const isTooWide = () => row.scrollWidth > row.clientWidth;

  function fit() {
    const seen = [
      NARROW.matches,
      row.clientWidth,
      ...own.map((each) => [/** @type {any} */ (each).hidden, each.textContent]),
    ];
    if (String(seen) === fitted) return;
    fitted = String(seen);
    row.classList.toggle("is-one-row", NARROW.matches);
    more.before(...menu.children);
    more.hidden = true;
    if (NARROW.matches && isTooWide()) {
      more.hidden = false;
      for (const each of own.slice(1).reverse()) {
        if (!isTooWide()) break;
        menu.prepend(each);
      }
    }
    changes.takeRecords();
  }

  const changes = new MutationObserver(fit); // a key is shown or hidden, or has another text
  const sizes = new ResizeObserver(fit);
  const watched = { subtree: true, characterData: true, attributes: true, attributeFilter: ["hidden"] };
  changes.observe(row, watched);
  sizes.observe(row);
  NARROW.addEventListener("change", fit);
  return () => {
    NARROW.removeEventListener("change", fit);
    changes.disconnect();
    sizes.disconnect();
  };
}
