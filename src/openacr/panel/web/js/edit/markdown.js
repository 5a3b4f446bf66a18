// The texts of the server about words: paragraphs, lists, bold and code of Markdown as elements.
import { h } from "../core/dom.js";

const PARTS = /\*\*([^*]+)\*\*|`([^`]+)`/g;

/** @param {string} text */
export function markdown(text) {
  return h(
    "div.about",
    {},
    ...text.split("\n\n").map((block) => {
      const lines = block.split("\n");
      if (lines.every((line) => line.startsWith("* ")))
        return h("ul", {}, ...lines.map((line) => h("li", {}, ...inline(line.slice(2)))));
      return h("p", {}, ...inline(block));
    }),
  );
}

/** @param {string} text */
function inline(text) {
  /** @type {(Node | string)[]} */
  const found = [];
  let at = 0;
  for (const match of text.matchAll(PARTS)) {
    found.push(text.slice(at, match.index), match[1] ? h("strong", {}, match[1]) : h("code", {}, match[2]));
    at = match.index + match[0].length;
  }
  return [...found, text.slice(at)];
}
