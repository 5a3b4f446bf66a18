// USER FILE, BATCH FILE and DRIP FEED as sources of a program.
import { get, latest } from "../core/api.js";
import { refuse } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { fileList } from "./file_list.js";

const PREVIEW = 200;

/**
 * @typedef {(cmd: string, values: Record<string, any>) => Promise<void>} Load
 *
 * @param {HTMLElement} host
 * @param {import("../core/signal.js").Endings} endings
 * @param {Load} load
 */
export function fileSource(host, endings, load) {
  source(host, endings, ["program", "other"], (path) => load("program.load", { path }));
}

/**
 * @param {HTMLElement} host
 * @param {import("../core/signal.js").Endings} endings
 * @param {Load} load
 */
export function batchSource(host, endings, load) {
  source(host, endings, ["batch", "program", "other"], (path) => load("program.batch", { path }));
}

/**
 * @param {HTMLElement} host
 * @param {import("../core/signal.js").Endings} _endings
 * @param {Load} load
 */
export function dripSource(host, _endings, load) {
  const port = h("input.field", { ariaLabel: t("load.port"), placeholder: "COM1, /dev/ttyS0", autocomplete: "off" });
  host.append(
    h(
      "div.stack",
      {},
      h("p", {}, t("load.drip.text")),
      h("label.row", {}, h("span.grow", {}, t("load.port")), port),
      keyOf("load.drip.start", () => load("program.drip", { port: port.value.trim() }), ".main.big"),
    ),
  );
}

/**
 * A list of files, the text of the chosen one, and LOAD FILE.
 * @param {HTMLElement} host
 * @param {import("../core/signal.js").Endings} endings
 * @param {string[]} kinds
 * @param {(path: string) => Promise<void>} load
 */
function source(host, endings, kinds, load) {
  let path = "";
  const newest = latest(endings);
  const text = h("pre.listing-plain.mono.grow.scroll", { tabIndex: 0, role: "region", ariaLabel: t("load.text") });
  const name = h("span.grow.quiet", {}, t("load.choose"));
  const key = keyOf("load.go", () => load(path), ".main.big", { disabled: true });
  const list = fileList({
    kinds,
    chosen: async (entry) => {
      path = entry.path;
      key.disabled = false;
      fill(name, entry.name);
      fill(text);
      try {
        const page = await newest(get("programs/text", { path, first: 1, lines: PREVIEW }));
        if (page)
          text.textContent =
            page.lines.join("\n") +
            (page.total > PREVIEW ? `\n\u2026 ${t("load.more", { count: page.total - PREVIEW })}` : "");
      } catch (error) {
        refuse(error);
      }
    },
    opened: (entry) => void load(entry.path),
  });
  host.append(h("div.load-two", {}, list.element, h("div.stack.load-side", {}, text, h("div.row", {}, name, key))));
}
