// LOAD PROG: user file, library part, DXF, batch, drip feed or LINK; afterwards the menu RUN PROG.
import { h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { Endings } from "../core/signal.js";
import { give } from "../core/app.js";
import { t } from "../core/texts.js";
import { showTab } from "../frame/display.js";
import { sayFindings, showFindings } from "../frame/findings.js";
import { openMenu } from "../frame/menu_bar.js";
import { batchSource, dripSource, fileSource } from "../load/files.js";
import { dxfSource } from "../load/dxf.js";
import { linkSource } from "../load/link.js";
import { partSource } from "../load/parts.js";

const TEXTS = { source: { en: "Source", de: "Quelle" } };

const SOURCES = {
  file: fileSource,
  part: partSource,
  dxf: dxfSource,
  batch: batchSource,
  drip: dripSource,
  link: linkSource,
};

/** @type {import("../frame/screen_host.js").Screen} */
export const screen = {
  title: { en: "Load program", de: "Programm laden" },
  area: "full",
  show({ body, endings, args }) {
    const own = new Endings();
    endings.add(() => own.end());
    const list = h("div.row.wrap.source-keys", { role: "radiogroup", ariaLabel: t(TEXTS.source) });
    const host = h("div.load-host.grow", {});
    body.append(list, host);
    const choose = (/** @type {keyof typeof SOURCES} */ name) => {
      own.end();
      host.replaceChildren();
      for (const key of list.querySelectorAll("button")) key.ariaChecked = String(key.dataset.source === name);
      void SOURCES[name](host, own, load);
    };
    list.append(
      ...Object.keys(SOURCES).map((name) =>
        keyOf(/** @type {any} */ (`load.${name}`), () => choose(/** @type {any} */ (name)), "", {
          role: "radio",
          data: { source: name },
        }),
      ),
    );
    choose(args.source ?? "file");
  },
};

/**
 * Load a program, then go to RUN PROG; the graphics of a program that is drawn are put up. One with errors is not
 * offered to be run: what is wrong with it is shown over the list.
 * @param {string} cmd
 * @param {Record<string, any>} values
 */
async function load(cmd, values) {
  const loaded = await give(cmd, values);
  if (!loaded) return;
  if (loaded.errors) {
    await showFindings();
    return;
  }
  openMenu("run");
  sayFindings(loaded.id);
  if (loaded.drawn) await showTab("graphics");
}
