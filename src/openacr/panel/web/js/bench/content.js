// What a pane shows: its module once this browser has the role for it, else a key that asks for it.
import { model, refuse } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { Endings } from "../core/signal.js";
import { t } from "../core/texts.js";
import { logIn } from "../frame/log_in.js";

/**
 * Show a pane in an element.
 * @param {HTMLElement} element
 * @param {import("./panes.js").Pane} pane
 * @param {Pick<import("./panes.js").Place, "kept" | "keep" | "number">} layout
 * @returns {{ end: () => void, mayClose: () => boolean | Promise<boolean> }}
 */
export function showPane(element, pane, layout) {
  const endings = new Endings();
  let isEnded = false;
  let mayClose = /** @type {() => boolean | Promise<boolean>} */ (() => true);
  let isShown = false;

  async function mount() {
    isShown = true;
    // A pane that is shown takes no focus from another.
    const [head, host] = [h("div.row.wrap.pane-head", {}), h("div.pane-body", { inert: true })];
    const past = pane.past && h("div.notice.pane-past", { role: "note" }, t(pane.past));
    fill(element, head, past, host);
    if (past)
      endings.add(
        model.timeline.watch(({ away }) => {
          past.hidden = !away;
        }),
      );
    try {
      const load = await pane.load();
      if (isEnded) return;
      const end = await load(host, {
        ...layout,
        head,
        beforeClose: (ask) => {
          mayClose = ask;
        },
      });
      if (isEnded) end();
      else endings.add(end);
    } catch (error) {
      refuse(error);
    }
    host.inert = false;
  }

  endings.add(
    model.hello.watch(({ client }) => {
      if (!client || isShown) return;
      const role = pane.role;
      if (!role || model.may(role)) void mount();
      else
        fill(
          element,
          h(
            "div.notice.row.wrap",
            {},
            h("span.grow", {}, t("role.needed", { role: t(/** @type {any} */ (`role.${role}`)) })),
            keyOf("login.go", () => logIn(role)),
          ),
        );
    }),
  );
  return {
    end() {
      isEnded = true;
      endings.end();
    },
    mayClose: () => mayClose(),
  };
}
