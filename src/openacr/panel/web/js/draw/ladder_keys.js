// The keyboard in a ladder: arrow keys go from symbol to symbol, Enter opens the menu of what has the focus.

/** @typedef {{ x: number, y: number }} Point the middle of a symbol */

/**
 * The symbol that an arrow key leads to: left and right within a rung, up and down to the nearest above or below.
 * @param {(Point & { rung: number })[]} symbols in their order
 * @param {number} at the present one
 * @param {string} key
 * @returns {number} the same where there is no other
 */
export function neighbourOf(symbols, at, key) {
  const here = symbols[at];
  if (!here) return at;
  const isAcross = key === "ArrowLeft" || key === "ArrowRight";
  const sign = key === "ArrowLeft" || key === "ArrowUp" ? -1 : 1;
  const [along, aside] = isAcross ? /** @type {const} */ (["x", "y"]) : /** @type {const} */ (["y", "x"]);
  let found = at;
  let least = Infinity;
  for (const [n, each] of symbols.entries()) {
    const ahead = sign * (each[along] - here[along]);
    if (ahead < 2 || (isAcross && each.rung !== here.rung)) continue;
    const far = ahead * 4 + Math.abs(each[aside] - here[aside]) * (isAcross ? 16 : 1);
    if (far < least) [found, least] = [n, far];
  }
  return found;
}

/**
 * Symbols of a ladder (`.rung .symbol`) are reached by the keyboard: Tab to the one that had the focus last.
 * @param {HTMLElement} ladder
 * @param {(symbol: SVGElement) => void} seen one has got the focus
 */
export function walkLadder(ladder, seen) {
  const symbols = () => /** @type {SVGElement[]} */ ([...ladder.querySelectorAll(".rung .symbol")]);
  ladder.addEventListener("focusin", ({ target }) => {
    const symbol = /** @type {Element} */ (target).closest(".symbol");
    if (!(symbol instanceof SVGElement)) return;
    for (const each of symbols()) each.tabIndex = each === symbol ? 0 : -1;
    seen(symbol);
  });
  ladder.addEventListener("keydown", (event) => {
    const all = symbols();
    const at = all.findIndex((each) => each === event.target);
    if (at < 0 || event.ctrlKey || event.altKey || event.metaKey) return;
    const rungs = [...ladder.querySelectorAll(".rung")];
    const { left, top, width, height } = all[at].getBoundingClientRect();
    if (event.key === "Enter")
      all[at].dispatchEvent(
        new MouseEvent("contextmenu", {
          bubbles: true,
          cancelable: true,
          clientX: left + width / 2,
          clientY: top + height,
        }),
      );
    else if (event.key.startsWith("Arrow")) {
      const places = all.map((each) => {
        const box = (each.querySelector(".fill") ?? each).getBoundingClientRect(); // without its texts
        const rung = rungs.findIndex((one) => one.contains(each));
        return { x: box.left + box.width / 2, y: box.top + box.height / 2, rung };
      });
      const next = all[neighbourOf(places, at, event.key)];
      next.focus();
      next.scrollIntoView({ block: "nearest", inline: "nearest" });
    } else return;
    event.preventDefault();
  });
}
