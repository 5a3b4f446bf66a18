// Building elements without a framework. Texts go in as text, never as HTML.

/** @typedef {Node | string | number | null | undefined | false} Child */

/**
 * Create an element: `h("button.key", { onclick: f, ariaLabel: "Stop" }, "STOP")`.
 *
 * The first argument is a tag with classes. Properties whose name begins with `on` are listeners,
 * `data` fills `dataset`, `attr` sets attributes, everything else is assigned as a property.
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K | `${K}.${string}`} what
 * @param {Record<string, any>} [properties]
 * @param {...(Child | Child[])} children
 * @returns {HTMLElementTagNameMap[K]}
 */
export function h(what, properties = {}, ...children) {
  const [tag, ...classes] = what.split(".");
  const element = /** @type {HTMLElementTagNameMap[K]} */ (document.createElement(tag));
  if (classes.length) element.className = classes.join(" ");
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined) continue;
    if (name === "data") Object.assign(element.dataset, value);
    else if (name === "attr") setAttributes(element, value);
    else if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else Reflect.set(element, name, value);
  }
  element.append(...children.flat().filter(isShown));
  return element;
}

/**
 * Set attributes; null and undefined remove one.
 * @param {Element} element
 * @param {Record<string, string | number | null | undefined>} attributes
 */
export function setAttributes(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined) element.removeAttribute(name);
    else element.setAttribute(name, String(value));
  }
}

/**
 * Set the text of an element only if it changes: selections and screen readers stay undisturbed.
 * @param {Element} element
 * @param {string} text
 */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/**
 * Replace the children of an element. The one that had the focus has it again, found by its name: what is drawn anew
 * takes nothing from the keyboard.
 * @param {Element} element
 * @param {...(Child | Child[])} children
 */
export function fill(element, ...children) {
  const before = document.activeElement;
  const name = before !== element && element.contains(before) ? nameOf(before) : "";
  element.replaceChildren(...children.flat().filter(isShown));
  if (!name) return;
  for (const each of element.querySelectorAll("button, input, select, textarea, [tabindex]"))
    if (nameOf(each) === name) return /** @type {HTMLElement} */ (each).focus();
}

/** What an element is, whatever it shows at the moment. @param {Element | null} element */
function nameOf(element) {
  if (!(element instanceof HTMLElement || element instanceof SVGElement)) return "";
  const data = element.dataset.name ?? element.dataset.item;
  return data || element.id || element.ariaLabel || element.textContent || "";
}

/**
 * The element with an id; its absence is a mistake in index.html.
 * @param {string} id
 */
export function byId(id) {
  const element = document.getElementById(id);
  if (!element) throw new Error(`index.html has no element "${id}"`);
  return element;
}

/**
 * @param {Child} child
 * @returns {child is Node | string}
 */
function isShown(child) {
  return child !== null && child !== undefined && child !== false;
}
