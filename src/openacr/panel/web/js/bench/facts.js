// What is known of a chosen parameter or flag, with keys that watch and change it.
import { fill, h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { changeValue, fullName } from "../frame/card_value.js";
import { addToWatchList } from "./watch_list.js";

/**
 * @param {HTMLElement} host
 * @param {import("../frame/card_value.js").Item | undefined} item
 * @param {() => string} shown its present value
 */
export function showFacts(host, item, shown) {
  if (!item) return fill(host);
  return fill(
    host,
    h(
      "div.grow",
      {},
      h("strong", {}, `${item.id} ${fullName(item)}`),
      h("p.hint", {}, [item.section, item.doc].filter(Boolean).join(" \u2014 ")),
    ),
    keyOf("tree.watch", () => addToWatchList(item.id)),
    keyOf("tree.change", () => changeValue(item, shown()), "", {
      disabled: !item.writable,
      title: item.writable ? "" : t("values.fixed"),
    }),
  );
}
