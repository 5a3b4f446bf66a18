// The lamp of inputs that are held by hand: how many, which, and RELEASE ALL. The card says which they are.
import { give, model, report } from "../core/app.js";
import { byId, fill, h, setText } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { ask } from "../frame/dialog.js";
import { logIn } from "../frame/log_in.js";

const TEXTS = {
  lamp: { en: "FORCED: {count}", de: "ERZWUNGEN: {count}" },
  title: { en: "Forced inputs", de: "Erzwungene Eing\u00e4nge" },
  none: { en: "No input is forced any more", de: "Kein Eingang ist mehr erzwungen" },
  about: {
    en: "A forced input keeps its level, whatever drives it, until it is released. Outputs, other flags and parameters cannot be held: the card, its programs and PLCs may change them at any time.",
    de: "Ein erzwungener Eingang beh\u00e4lt seinen Pegel, was immer ihn treibt, bis er freigegeben wird. Ausg\u00e4nge, andere Merker und Parameter lassen sich nicht festhalten: Die Karte, ihre Programme und SPS-Programme k\u00f6nnen sie jederzeit \u00e4ndern.",
  },
  release: { en: "RELEASE", de: "FREIGEBEN" },
  releaseAll: { en: "RELEASE ALL", de: "ALLE FREIGEBEN" },
  released: {
    en: "{count} {count|input was|inputs were} released",
    de: "{count} {count|Eingang wurde|Eing\u00e4nge wurden} freigegeben",
  },
};

export function startForced() {
  const lamp = h("button.key.forced-lamp", { type: "button", hidden: true, onclick: () => void showForced() });
  byId("tools").before(lamp);
  model.forced.watch(({ forced }) => {
    lamp.hidden = !forced.length;
    setText(lamp, t(TEXTS.lamp, { count: forced.length }));
    lamp.title = forced.map(({ input, what }) => `${input} ${what}`).join(", ");
  });
}

/**
 * @param {string} command
 * @param {Record<string, any>} [args]
 */
async function change(command, args) {
  return model.may("service") || (await logIn("service")) ? give(command, args) : null;
}

async function showForced() {
  const rows = h("div.list", {});
  const end = model.forced.watch(({ forced }) =>
    fill(
      rows,
      ...forced.map(({ input, on, what }) =>
        h(
          "div.row",
          {},
          h("span.number", {}, `BIT${input}`),
          h("span.grow", {}, what),
          h("strong", {}, t(on ? "io.on" : "io.off")),
          keyOf(TEXTS.release, () => change("world.input", { input, state: "released" }), "", {
            ariaLabel: `${t(TEXTS.release)} BIT${input}`,
          }),
        ),
      ),
      forced.length ? null : h("p.hint", {}, t(TEXTS.none)),
    ),
  );
  const chosen = await ask({
    title: t(TEXTS.title),
    body: [rows, h("p.hint", {}, t(TEXTS.about))],
    choices: [
      { text: t(TEXTS.releaseAll), value: true, kind: "danger" },
      { text: t("key.close"), value: null },
    ],
  });
  end();
  const answer = chosen ? await change("world.release") : null;
  if (answer) report(t(TEXTS.released, { count: answer.released }));
}
