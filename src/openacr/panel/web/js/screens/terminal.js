// TERMINAL: the direct line to the card, with its control keys.
import { give, link, model } from "../core/app.js";
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { FitAddon, Terminal } from "../../vendor/xterm.js";

const KEYS = ["esc", "ctrl-c", "ctrl-x", "ctrl-y", "ctrl-z"];

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: "terminal.title",
  area: "full",
  async show({ body, head, endings }) {
    const host = h("div.terminal.grow", {});
    const line = h("input.field.mono.grow", { ariaLabel: t("terminal.line"), autocomplete: "off", spellcheck: false, autofocus: true });
    /** @type {string[]} */
    const history = [];
    let place = 0;
    head.append(...KEYS.map((key) => h("button.key", { type: "button", onclick: () => give("term.key", { key }) }, key.replace("ctrl-", "Ctrl-").replace("esc", "Esc"))));
    body.append(h("div.notice", {}, t("diag.warning")), host, h("form.row", { onsubmit: (/** @type {Event} */ event) => {
      event.preventDefault();
      history.push(line.value);
      place = 0;
      void give("term.line", { text: line.value });
      line.value = "";
    } }, line, h("button.key.main", { type: "submit" }, t("terminal.send"))));
    line.addEventListener("keydown", (event) => {
      if (event.key !== "ArrowUp" && event.key !== "ArrowDown") return;
      event.preventDefault();
      place = Math.min(history.length, Math.max(0, place + (event.key === "ArrowUp" ? 1 : -1)));
      line.value = place ? history[history.length - place] : "";
    });
    const style = getComputedStyle(body);
    const term = new Terminal({ convertEol: true, disableStdin: true, scrollback: 5000, fontFamily: style.getPropertyValue("--mono"), fontSize: 14, screenReaderMode: true, cursorStyle: "underline" });
    const fit = new FitAddon();
    term.loadAddon(fit);
    term.open(host);
    const ends = adoptStyles(host);
    const theme = () => {
      const { color } = getComputedStyle(host);
      term.options.theme = { background: getComputedStyle(host).backgroundColor, foreground: color, cursor: color };
    };
    theme();
    const sizes = new ResizeObserver(() => fit.fit());
    sizes.observe(host);
    document.documentElement.addEventListener("theme", theme);
    let isFirst = true;
    endings.add(
      model.term.watch((text) => {
        if (!isFirst) term.write(text);
        isFirst = false;
      }),
      () => sizes.disconnect(), ends, () => document.documentElement.removeEventListener("theme", theme),
      () => { if (link.isOpen.value) void link.command("term.close").catch(() => {}); }, () => term.dispose(), link.subscribe({ topic: "term" }),
    );
    await give("term.open");
  },
};

/**
 * The rules that the terminal keeps in templates (web-bundle/bundle.mjs) as a sheet that acts.
 * @param {HTMLElement} host
 */
function adoptStyles(host) {
  const sheet = new CSSStyleSheet();
  const copy = () => sheet.replaceSync([...host.querySelectorAll("template")].map((each) => each.textContent).join("\n"));
  const observer = new MutationObserver(copy);
  observer.observe(host, { childList: true, subtree: true, characterData: true });
  document.adoptedStyleSheets = [...document.adoptedStyleSheets, sheet];
  copy();
  return () => {
    observer.disconnect();
    document.adoptedStyleSheets = document.adoptedStyleSheets.filter((each) => each !== sheet);
  };
}
