// What this browser keeps for itself: theme, language, chosen tabs. Nothing of the machine.

const PREFIX = "openacr.panel.";

/**
 * @param {string} name
 * @param {string} fallback
 */
export function setting(name, fallback) {
  try {
    return window.localStorage.getItem(PREFIX + name) ?? fallback;
  } catch {
    return fallback; // storage switched off in this browser
  }
}

/**
 * @param {string} name
 * @param {string} value
 */
export function keepSetting(name, value) {
  try {
    window.localStorage.setItem(PREFIX + name, value);
  } catch {
    // Without storage the choice lasts until the page is left.
  }
}

/** Forget everything of the operator's workspace: RESIZE SCREEN. */
export function forgetSettings() {
  try {
    for (const name of Object.keys(window.localStorage))
      if (name.startsWith(PREFIX) && !name.startsWith(`${PREFIX}bench.`)) window.localStorage.removeItem(name);
  } catch {
    // Nothing was kept.
  }
}

/** Pictures read their colours anew when the system changes between light and dark. */
export function followSystemTheme() {
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", applyTheme);
}

/** Apply the chosen theme; "auto" follows the system. */
export function applyTheme() {
  const theme = setting("theme", "auto");
  if (theme === "auto") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = theme;
  document.documentElement.dispatchEvent(new Event("theme"));
}
