// DXF FILE: a drawing becomes a part program; continuous path or drill pattern.
import { ApiError, get, latest, send } from "../core/api.js";
import { refuse, report } from "../core/app.js";
import { numberIn } from "../core/arithmetic.js";
import { fill, h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { t } from "../core/texts.js";
import { fetchPath } from "../draw/path.js";
import { createPicture } from "../draw/picture.js";
import { confirm } from "../frame/dialog.js";
import { openScreen } from "../frame/screen_host.js";
import { fileList } from "./file_list.js";

/**
 * @param {HTMLElement} host
 * @param {import("../core/signal.js").Endings} endings
 * @param {import("./files.js").Load} load
 */
export async function dxfSource(host, endings, load) {
  let [path, written] = ["", ""];
  const [newestLayers, newestPath] = [latest(endings), latest(endings)];
  const fields = createFields();
  const drawing = h("div.preview.grow", {});
  const notes = h("div.scroll.dxf-notes", { role: "status" });
  const convert = keyOf("dxf.convert", () => make(false), ".main", { disabled: true });
  const edit = keyOf("menu.edit", () => openScreen("edit", { path: written }), "", { disabled: true });
  const go = keyOf("load.go", () => load("program.load", { path: written }), ".big", { disabled: true });
  const list = fileList({
    kinds: ["dxf"],
    chosen: async (entry) => {
      path = entry.path;
      convert.disabled = false;
      fields.output.value = entry.path.replace(/\.dxf$/i, "") + ".TXT";
      fill(fields.layer, h("option", { value: "" }, t("dxf.all")));
      const found = await newestLayers(get("dxf/layers", { path })).catch(() => undefined);
      if (found)
        fields.layer.append(
          ...found.layers.map((/** @type {any} */ each) =>
            h("option", { value: each.name ?? each }, each.name ?? each),
          ),
        );
    },
  });
  host.append(
    h(
      "div.load-parts",
      {},
      list.element,
      fields.element,
      h("div.stack.load-side", {}, drawing, notes, h("div.row.wrap", {}, convert, h("span.grow", {}), edit, go)),
    ),
  );
  const picture = await createPicture(drawing, endings);

  /** @param {boolean} replace */
  async function make(replace) {
    try {
      const answer = await send("POST", "dxf", { path, replace, ...fields.values() });
      written = answer.path;
      go.disabled = edit.disabled = false;
      report(t("dxf.done", { name: written }));
      fill(notes, ...answer.notes.map((/** @type {string} */ text) => h("div.notice", {}, text)));
      await list.read();
      const drawn = await newestPath(fetchPath("path", { path: written }));
      if (drawn) picture.setPath(drawn);
    } catch (error) {
      const isThere = error instanceof ApiError && error.body?.error?.code === "conflict";
      if (!isThere) refuse(error);
      else if (await confirm(t("dxf.convert"), error.message, t("edit.overwrite"))) await make(true);
    }
  }
}

/** What is asked of a drawing; a number that is left empty is as the parameters of the machine say. */
function createFields() {
  const kind = h(
    "select.field",
    { onchange: () => draw() },
    h("option", { value: "" }, t("dxf.path")),
    h("option", { value: "1" }, t("dxf.drill")),
  );
  const depth = numberField();
  const tool = numberField();
  const direction = h(
    "select.field",
    {},
    h("option", { value: "0" }, t("dxf.cw")),
    h("option", { value: "1" }, t("dxf.ccw")),
  );
  const layer = h("select.field", { ariaLabel: t("dxf.layer") }, h("option", { value: "" }, t("dxf.all")));
  const output = h("input.field.mono", { ariaLabel: t("dxf.output"), autocomplete: "off", spellcheck: false });
  const row = (/** @type {string} */ label, /** @type {HTMLElement} */ field) =>
    h("label.stack.dxf-field", {}, h("span", {}, label), field);
  const ofPath = [row(t("dxf.direction"), direction), row(t("dxf.tool"), tool)];
  const draw = () =>
    ofPath.forEach((each) => {
      each.hidden = kind.value === "1";
    });
  const element = h(
    "div.stack.scroll.part-form",
    {},
    row(t("dxf.kind"), kind),
    row(t("dxf.depth"), depth),
    row(t("dxf.output"), output),
    ...ofPath,
    row(t("dxf.layer"), layer),
  );
  const values = () => {
    const isDrill = kind.value === "1";
    const z = numberIn(depth, t("dxf.depth"));
    return {
      output: output.value.trim(),
      layer: layer.value,
      drill: isDrill,
      direction: Number(direction.value),
      tool: isDrill ? 0 : (numberIn(tool, t("dxf.tool")) ?? 0),
      ...(z === null ? {} : { [isDrill ? "drill_z" : "cut_z"]: z }),
    };
  };
  return { element, output, layer, values };
}

function numberField() {
  return h("input.field.number", { inputMode: "decimal", autocomplete: "off" });
}
