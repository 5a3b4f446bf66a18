// STOCK of the GRAPHICS tab: what the loaded program leaves of the blank, instead of its path.
import { address, call } from "../core/api.js";
import { h, setText } from "../core/dom.js";
import { t } from "../core/texts.js";
import { fetchStock } from "../draw/stock.js";

const SHOWN = 8; // lines that are named

/** The key that switches the view, and a note on what was found. */
export function stockView() {
  const key = h("button.key", { type: "button", ariaPressed: "false" }, t("graphics.stock"));
  const note = h("div.picture-note.stock-note", { role: "status" });
  let turn = new AbortController();
  let program = "";
  /** @type {import("../draw/picture.js").Picture | null} */
  let picture = null;
  const isOn = () => key.getAttribute("aria-pressed") === "true";

  async function compute() {
    turn.abort();
    const mine = (turn = new AbortController());
    try {
      const stock = await fetchStock(
        (share) => setText(note, t("graphics.computing", { percent: Math.floor(100 * share) })),
        mine.signal,
      );
      if (mine.signal.aborted) return;
      picture?.setStock(stock);
      const found = [...named("graphics.dip", stock.rapidLines), ...named("graphics.below", stock.belowLines)];
      setText(note, found.join(" \u00b7 ") || t("graphics.sound"));
    } catch (error) {
      if (mine.signal.aborted) return;
      leave();
      setText(note, error instanceof Error ? error.message : String(error));
    }
  }

  function leave() {
    key.setAttribute("aria-pressed", "false");
    turn.abort();
    picture?.setStock(null);
  }

  key.addEventListener("click", () => {
    setText(note, "");
    if (isOn()) {
      leave();
      call(address("stock"), { method: "DELETE" }).catch(() => {}); // a lost link ends it as well
    } else {
      key.setAttribute("aria-pressed", "true");
      void compute();
    }
  });

  return {
    key,
    note,
    /**
     * @param {import("../draw/picture.js").Picture} shown
     * @param {import("../core/signal.js").Endings} endings
     */
    show(shown, endings) {
      picture = shown;
      endings.add(() => turn.abort());
    },
    /** Another program is loaded: its stock. @param {string} id */
    follow(id) {
      if (id === program) return;
      program = id;
      if (isOn()) void compute();
    },
    /** Settings have changed. */
    renew() {
      if (isOn()) void compute();
    },
  };
}

/**
 * What was found, with the first lines it happens at.
 * @param {"graphics.dip" | "graphics.below"} text
 * @param {Uint32Array} lines
 */
function named(text, lines) {
  if (!lines.length) return [];
  const more = lines.length > SHOWN ? " \u2026" : "";
  return [t(text, { lines: [...lines.slice(0, SHOWN)].join(", ") + more })];
}
