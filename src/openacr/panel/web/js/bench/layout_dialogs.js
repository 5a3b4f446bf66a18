// Dialogs of the workspace: which pane is opened, which layout is taken or kept.
import { report } from "../core/app.js";
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { ask, askText, confirm } from "../frame/dialog.js";
import { keepNamedLayouts, namedLayouts } from "./layouts.js";
import { PANES } from "./panes.js";
import { arrange, layoutNow, mayCloseAll, openPane } from "./workspace.js";

/** Choose a pane from all there are. */
export async function choosePane() {
  let chosen = "";
  const tiles = Object.entries(PANES).map(([pane, { title }]) =>
    h(
      "button.key",
      {
        type: "submit",
        onclick: () => {
          chosen = pane;
        },
      },
      t(title),
    ),
  );
  const submit = { text: t("key.cancel"), value: () => chosen || null, isSubmit: true };
  const pane = await ask({
    title: t("bench.panes"),
    className: "wide",
    first: tiles[0],
    body: [h("div.tiles", {}, ...tiles)],
    choices: [submit],
  });
  if (pane) openPane(pane, { isNew: true });
}

/** Keep the layout under a name, take one, delete one, or go back to the first one. */
export async function chooseLayout() {
  const named = namedLayouts();
  let chosen = "";
  const rows = Object.keys(named)
    .sort()
    .map((name) =>
      h(
        "div.row",
        { data: { layout: name } },
        h(
          "button.key.grow",
          {
            type: "submit",
            onclick: () => {
              chosen = name;
            },
          },
          name,
        ),
        h(
          "button.key.bad",
          {
            type: "button",
            ariaLabel: t("bench.delete", { name }),
            title: t("bench.delete", { name }),
            onclick: () => {
              delete named[name];
              keepNamedLayouts(named);
              document.querySelector(`[data-layout="${CSS.escape(name)}"]`)?.remove();
            },
          },
          "\u00d7",
        ),
      ),
    );
  const what = await ask({
    title: t("bench.layouts"),
    body: rows.length ? rows : [h("p.hint", {}, t("bench.nolayout"))],
    choices: [
      { text: t("bench.reset"), value: "reset" },
      { text: t("bench.save"), value: "save" },
      { text: t("key.close"), value: () => (chosen ? "take" : null), isSubmit: true },
    ],
  });
  if (what === "save") await keepNamed(named);
  else if (what === "take" && (await mayCloseAll())) arrange(named[chosen]);
  else if (what === "reset" && (await mayCloseAll())) arrange(null);
}

/** @param {Record<string, import("./layouts.js").Layout>} named */
async function keepNamed(named) {
  const name = await askText(t("bench.save"), t("bench.name"));
  if (!name || (name in named && !(await confirm(t("bench.save"), t("bench.replace", { name }), t("bench.save")))))
    return;
  keepNamedLayouts({ ...named, [name]: layoutNow() });
  report(t("bench.saved", { name }));
}
