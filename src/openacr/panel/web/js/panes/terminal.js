// A terminal of the card: a direct line with its control keys.
import { give, link, model } from "../core/app.js";
import { h } from "../core/dom.js";
import { Endings } from "../core/signal.js";
import { t } from "../core/texts.js";
import { FitAddon, Terminal } from "../../vendor/xterm.js";

const TEXTS = { line: { en: "Line for the card", de: "Zeile an die Karte" }, send: { en: "SEND", de: "SENDEN" } };

const KEYS = ["esc", "ctrl-c", "ctrl-x", "ctrl-y", "ctrl-z"];

/**
 * Show a terminal; returns what ends it.
 * @param {HTMLElement} host
 * @param {{ head: HTMLElement, number: number }} place `number`: which of the terminals, from 1
 */
export async function mount(host, { head, number }) {
  const endings = new Endings();
  const terminal = number - 1;
  const screen = h("div.terminal.grow", {});
  head.append(
    ...KEYS.map((key) =>
      h(
        "button.key",
        { type: "button", onclick: () => give("term.key", { terminal, key }) },
        key.replace("ctrl-", "Ctrl-").replace("esc", "Esc"),
      ),
    ),
  );
  host.append(
    h("div.notice", {}, t("diag.warning")),
    screen,
    lineOf((text) => void give("term.line", { terminal, text })),
  );
  const term = new Terminal({
    convertEol: true,
    disableStdin: true,
    scrollback: 5000,
    fontFamily: getComputedStyle(host).getPropertyValue("--mono"),
    fontSize: 14,
    screenReaderMode: true,
    cursorStyle: "underline",
  });
  const fit = new FitAddon();
  term.loadAddon(fit);
  term.open(screen);
  const ends = adoptStyles(screen);
  const theme = () => {
    const { color } = getComputedStyle(screen);
    term.options.theme = { background: getComputedStyle(screen).backgroundColor, foreground: color, cursor: color };
  };
  theme();
  const sizes = new ResizeObserver(() => fit.fit());
  sizes.observe(screen);
  document.documentElement.addEventListener("theme", theme);
  const before = model.term.value; // was for those that were open then
  let client = 0;
  endings.add(
    model.term.watch((printed) => {
      if (printed !== before && printed?.terminal === terminal) term.write(printed.text);
    }),
    () => sizes.disconnect(),
    ends,
    () => document.documentElement.removeEventListener("theme", theme),
    () => {
      if (link.isOpen.value) void link.command("term.close", { terminal }).catch(() => {});
    },
    () => term.dispose(),
    model.hello.watch((hello) => {
      if (!hello.client || hello.client === client) return;
      client = hello.client; // of another connection: what the one before had open is closed
      void give("term.open", { terminal });
    }),
  );
  return () => endings.end();
}

/**
 * The line that is typed, with those before it under the arrow keys.
 * @param {(text: string) => void} send
 */
function lineOf(send) {
  const line = h("input.field.mono.grow", { ariaLabel: t(TEXTS.line), autocomplete: "off", spellcheck: false });
  /** @type {string[]} */
  const history = [];
  let place = 0;
  line.addEventListener("keydown", (event) => {
    if (event.key !== "ArrowUp" && event.key !== "ArrowDown") return;
    event.preventDefault();
    place = Math.min(history.length, Math.max(0, place + (event.key === "ArrowUp" ? 1 : -1)));
    line.value = place ? history[history.length - place] : "";
  });
  return h(
    "form.row",
    {
      onsubmit: (/** @type {Event} */ event) => {
        event.preventDefault();
        history.push(line.value);
        place = 0;
        send(line.value);
        line.value = "";
      },
    },
    line,
    h("button.key.main", { type: "submit" }, t(TEXTS.send)),
  );
}

/**
 * The rules that the terminal keeps in templates (web-bundle/bundle.mjs) as a sheet that acts.
 * @param {HTMLElement} host
 */
function adoptStyles(host) {
  const sheet = new CSSStyleSheet();
  const copy = () =>
    sheet.replaceSync([...host.querySelectorAll("template")].map((each) => each.textContent).join("\n"));
  const observer = new MutationObserver(copy);
  observer.observe(host, { childList: true, subtree: true, characterData: true });
  document.adoptedStyleSheets = [...document.adoptedStyleSheets, sheet];
  copy();
  return () => {
    observer.disconnect();
    document.adoptedStyleSheets = document.adoptedStyleSheets.filter((each) => each !== sheet);
  };
}
