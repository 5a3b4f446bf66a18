// LINK: a part program is received over a serial line and kept as a file, to be loaded like any other.
import { ApiError, call, get, send } from "../core/api.js";
import { refuse } from "../core/app.js";
import { h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { size } from "../core/format.js";
import { t } from "../core/texts.js";
import { confirm } from "../frame/dialog.js";

const AGAIN_MS = 300;

/**
 * @typedef {{ state: "" | "receiving" | "kept" | "cancelled" | "failed", path: string, port: string, bytes: number,
 *   lines: number, text: string }} Reception
 *
 * @param {HTMLElement} host
 * @param {import("../core/signal.js").Endings} endings
 * @param {import("./files.js").Load} load
 */
export function linkSource(host, endings, load) {
  let kept = "";
  let isShown = true;
  const port = h("input.field", { ariaLabel: t("load.port"), placeholder: "COM1, /dev/ttyS0", autocomplete: "off" });
  const file = h("input.field.mono", {
    ariaLabel: t("load.link.file"),
    autocomplete: "off",
    spellcheck: false,
    oninput: () => {
      begin.disabled = file.value.trim() === "";
    },
  });
  const begin = keyOf("load.link.start", () => receive(false), ".main.big", { disabled: true });
  const cancel = keyOf("key.cancel", () => call("/api/link", { method: "DELETE" }).then(follow, refuse), ".big", {
    hidden: true,
  });
  const go = keyOf("load.go", () => load("program.load", { path: kept }), ".big", { disabled: true });
  const note = h("p.notice", { role: "status", hidden: true });
  host.append(
    h(
      "div.stack",
      {},
      h("p", {}, t("load.link.text")),
      h("label.row", {}, h("span.grow", {}, t("load.port")), port),
      h("label.row", {}, h("span.grow", {}, t("load.link.file")), file),
      h("div.row", {}, begin, cancel, go),
      note,
    ),
  );
  let timer = setTimeout(() => {}, 0);
  endings.add(() => {
    isShown = false;
    clearTimeout(timer);
  });

  /** @param {boolean} replace */
  async function receive(replace) {
    const path = file.value.trim();
    try {
      await send("POST", "link", { path, port: port.value.trim(), replace });
      await follow();
    } catch (error) {
      const isThere = !replace && error instanceof ApiError && error.body?.error?.exists === true;
      if (!isThere) refuse(error);
      else if (await confirm(t("load.link.start"), error.message, t("edit.overwrite"))) await receive(true);
    }
  }

  /** Show how far it is, again and again until it has ended. */
  async function follow() {
    clearTimeout(timer);
    const now = await get("link").catch(refuse);
    if (!isShown) return;
    if (!now || now.state === "receiving") timer = setTimeout(follow, AGAIN_MS);
    if (now) show(now);
  }

  /** @param {Reception} now */
  function show(now) {
    const isReceiving = now.state === "receiving";
    begin.hidden = port.disabled = file.disabled = isReceiving;
    cancel.hidden = !isReceiving;
    kept = now.state === "kept" ? now.path : "";
    go.disabled = !kept;
    note.hidden = !now.state;
    note.classList.toggle("bad", now.state === "failed");
    note.classList.toggle("good", now.state === "kept");
    const facts = { name: now.path, bytes: size(now.bytes), lines: now.lines, port: now.port };
    note.textContent = now.state === "failed" ? now.text : now.state ? t(`load.link.${now.state}`, facts) : "";
  }
  void follow();
}
