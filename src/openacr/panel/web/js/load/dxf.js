// DXF FILE: a drawing becomes a part program; continuous path or drill pattern.
import { get, send } from "../core/api.js";
import { refuse, report } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { fetchPath } from "../draw/path.js";
import { createPicture } from "../draw/picture.js";
import { fileList } from "./file_list.js";

/**
 * @param {HTMLElement} host
 * @param {import("../core/signal.js").Endings} endings
 * @param {import("./files.js").Load} load
 */
export async function dxfSource(host, endings, load) {
  let [path, written] = ["", ""];
  const layer = h("select.field", { ariaLabel: t("dxf.layer") }, h("option", { value: "" }, t("dxf.all")));
  const direction = h("select.field", {}, h("option", { value: "0" }, t("dxf.cw")), h("option", { value: "1" }, t("dxf.ccw")));
  const kind = h("select.field", {}, h("option", { value: "" }, t("dxf.path")), h("option", { value: "1" }, t("dxf.drill")));
  const output = h("input.field.mono", { ariaLabel: t("dxf.output"), autocomplete: "off", spellcheck: false });
  const [convert, go] = [h("button.key.main", { type: "button", disabled: true, onclick: () => make() }, t("dxf.convert")), h("button.key.big", { type: "button", disabled: true, onclick: () => load("program.load", { path: written }) }, t("load.go"))];
  const drawing = h("div.preview", {});
  const list = fileList({ kinds: ["dxf"], chosen: async (entry) => {
    path = entry.path;
    convert.disabled = false;
    output.value = entry.path.replace(/\.dxf$/i, "") + ".TXT";
    const { layers } = await get("dxf/layers", { path }).catch(() => ({ layers: [] }));
    fill(layer, h("option", { value: "" }, t("dxf.all")), ...layers.map((/** @type {any} */ each) => h("option", { value: each.name ?? each }, each.name ?? each)));
  } });
  const row = (/** @type {string} */ label, /** @type {HTMLElement} */ field) => h("label.row", {}, h("span.grow", {}, label), field);
  host.append(h("div.load-two", {}, list.element, h("div.stack.load-side.scroll", {}, row(t("dxf.kind"), kind), row(t("dxf.direction"), direction), row(t("dxf.layer"), layer), row(t("dxf.output"), output),
    h("div.row", {}, convert, h("span.grow", {}), go), drawing)));
  const picture = await createPicture(drawing, endings);

  async function make() {
    try {
      const answer = await send("POST", "dxf", { path, direction: Number(direction.value), layer: layer.value, drill: kind.value === "1", output: output.value.trim() });
      written = answer.path;
      go.disabled = false;
      report(t("dxf.done", { name: written }));
      await list.read();
      picture.setPath(await fetchPath("path", { path: written }));
    } catch (error) {
      refuse(error);
    }
  }
}
