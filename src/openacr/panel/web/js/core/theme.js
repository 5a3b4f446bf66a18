// Colours have changed: what is drawn on a canvas is drawn again.

/**
 * Call a function once the theme is another one, chosen here or by the system; returns the function that ends it.
 * @param {() => void} act
 */
export function onTheme(act) {
  document.documentElement.addEventListener("theme", act);
  return () => document.documentElement.removeEventListener("theme", act);
}
