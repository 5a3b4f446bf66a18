// Keys of the keyboard in words: for people, and for screen readers.

/** Keys as they are written on the keyboard: Strg in German. @param {string} keys */
export function shownKeys(keys) {
  return document.documentElement.lang === "de"
    ? keys.replaceAll("Ctrl", "Strg").replaceAll("Shift", "Umschalt").replaceAll("Enter", "Eingabe")
    : keys;
}

/** Keys for screen readers. @param {string} keys */
export function spokenKeys(keys) {
  return keys.replaceAll("Ctrl", "Control").replaceAll(",", "");
}

/**
 * Whether a key is pressed with its modifiers, and no others; by its place on an English keyboard.
 * @param {KeyboardEvent} event
 * @param {string} keys e.g. Ctrl+Alt+1
 */
export function isPressed(event, keys) {
  const parts = keys.split("+");
  const key = parts.at(-1) ?? "";
  const code = /^\d$/.test(key) ? `Digit${key}` : /^[A-Z]$/.test(key) ? `Key${key}` : key;
  return (
    (event.code === code || (key === "Enter" && event.key === "Enter")) &&
    event.ctrlKey === parts.includes("Ctrl") &&
    event.altKey === parts.includes("Alt") &&
    event.shiftKey === parts.includes("Shift") &&
    !event.metaKey &&
    !event.getModifierState("AltGraph") // it types the third sign of a key
  );
}
