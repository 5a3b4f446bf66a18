// A listing of any length: only the lines in sight exist; it follows the executing line.
import { h } from "../core/dom.js";

const CHUNK = 200;
const AROUND = 15; // lines kept before and after the ones in sight

/**
 * @typedef {{ setTotal: (total: number) => void, mark: (line: number, follow: boolean) => void,
 *   choose: (line: number) => void, forget: () => void }} Listing
 */

/**
 * @param {HTMLElement} host
 * @param {{ read: (first: number, count: number) => Promise<string[]>, numberOf?: (line: number) => string,
 *   clicked: (line: number) => void, scrolled: () => void, label: string }} options
 * @returns {Listing}
 */
export function createListing(host, { read, clicked, scrolled, label, numberOf = String }) {
  const rows = h("div.listing-rows", {});
  const space = h("div.listing-space", {}, rows);
  const box = h("div.listing.mono.scroll", { tabIndex: 0, role: "listbox", ariaLabel: label }, space);
  host.append(box);
  /** @type {Map<number, string[]>} */
  const chunks = new Map();
  /** @type {Set<number>} */
  const asked = new Set();
  let [total, active, chosen, version, isOwn] = [0, 0, 0, 0, false];

  const height = () => Math.max(16, rowHeight(box));
  function draw() {
    const tall = height();
    space.style.height = `${total * tall}px`;
    const first = Math.max(1, Math.floor(box.scrollTop / tall) + 1 - AROUND);
    const last = Math.min(total, Math.ceil((box.scrollTop + box.clientHeight) / tall) + AROUND);
    rows.style.transform = `translateY(${(first - 1) * tall}px)`;
    const shown = [];
    for (let line = first; line <= last; line++) shown.push(rowOf(line));
    rows.replaceChildren(...shown);
  }

  /** @param {number} line */
  function rowOf(line) {
    const chunk = Math.floor((line - 1) / CHUNK);
    const text = chunks.get(chunk)?.[(line - 1) % CHUNK];
    if (text === undefined) void fetchChunk(chunk);
    return h(
      "div.listing-row",
      {
        role: "option",
        className: `listing-row${line === active ? " is-active" : ""}${line === chosen ? " is-chosen" : ""}`,
        data: { line: String(line) },
        attr: { "aria-selected": String(line === active) },
        onclick: () => clicked(line),
      },
      h("span.listing-mark", { ariaHidden: "true" }, line === active ? "\u25b6" : ""),
      h("span.listing-number", {}, numberOf(line)),
      h("span.listing-text", {}, text ?? "\u2026"),
    );
  }

  /** @param {number} chunk */
  async function fetchChunk(chunk) {
    if (asked.has(chunk)) return;
    asked.add(chunk);
    const now = version;
    const lines = await read(chunk * CHUNK + 1, CHUNK).catch(() => []);
    if (now !== version) return;
    chunks.set(chunk, lines);
    draw();
  }

  box.addEventListener("scroll", () => {
    if (!isOwn) scrolled();
    isOwn = false;
    draw();
  });
  new ResizeObserver(() => draw()).observe(box);

  /** @param {number} line */
  function scrollTo(line) {
    const top = Math.max(0, (line - 0.5) * height() - box.clientHeight / 2);
    if (Math.abs(box.scrollTop - top) < 1) return;
    isOwn = true;
    box.scrollTop = top;
  }
  return {
    setTotal(count) {
      total = count;
      draw();
    },
    mark(line, follow) {
      active = line;
      if (follow && line) scrollTo(line);
      draw();
    },
    choose(line) {
      if (chosen === line) return;
      chosen = line;
      if (line) scrollTo(line);
      draw();
    },
    forget() {
      chunks.clear();
      asked.clear();
      version++;
    },
  };
}

/** @param {HTMLElement} box */
function rowHeight(box) {
  return (
    parseFloat(getComputedStyle(box).getPropertyValue("--row-height")) * parseFloat(getComputedStyle(box).fontSize)
  );
}
