// Names of parameters and flags anywhere in the workspace (`data-item`): dragged into a pane, or with a menu of their own.

import { want } from "./wanted.js";

const TEXTS = {
  watch: { en: "watch", de: "beobachten" },
  scope: { en: "scope", de: "Scope" },
  compare: { en: "compare", de: "vergleichen" },
  values: { en: "show in Values", de: "in Werte zeigen" },
  used: { en: "where used", de: "wo verwendet" },
};

/**
 * What can be done with a parameter or flag, by the keys of the search.
 * @param {string} id P12288 or BIT516
 * @returns {import("./palette_entries.js").Act[]}
 */
export function actsOn(id) {
  return [
    { label: TEXTS.watch, keys: "Enter", does: () => want("watch", id) },
    { label: TEXTS.scope, keys: "Ctrl+Enter", does: () => want("scope", id) },
    { label: TEXTS.compare, keys: "Shift+Enter", does: () => want("timeline", id) },
    { label: TEXTS.values, keys: "Alt+Enter", does: () => want("tree", id) },
    {
      label: TEXTS.used,
      keys: "Ctrl+Shift+Enter",
      does: async () => (await import("./palette.js")).openPalette(`:${id}`),
    },
  ];
}
