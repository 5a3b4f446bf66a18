// The part folder of the server as a list; files can be dropped on it.
import { address, call, get, latest } from "../core/api.js";
import { model, refuse, report } from "../core/app.js";
import { fill, h } from "../core/dom.js";
import { keyOf } from "../core/keys.js";
import { size } from "../core/format.js";
import { t } from "../core/texts.js";

/**
 * @typedef {{ name: string, path: string, kind: string, bytes: number, changed: string, locked: boolean }} Entry
 *
 * @param {{ kinds: string[], chosen: (entry: Entry) => void, opened?: (entry: Entry) => void }} options
 */
export function fileList({ kinds, chosen, opened = () => {} }) {
  const rows = h("div.list.grow.scroll", { role: "listbox", ariaLabel: t("load.files") });
  const place = h("span.grow.mono", {});
  const input = h("input", {
    type: "file",
    hidden: true,
    multiple: true,
    onchange: () => void upload([...(input.files ?? [])]),
  });
  const element = h(
    "section.file-list",
    {},
    h(
      "div.row",
      {},
      place,
      keyOf("load.upload", () => input.click()),
      input,
    ),
    rows,
    h("p.hint", {}, t("load.drop")),
  );
  let folder = "";
  const newest = latest();
  element.addEventListener("dragover", (event) => {
    event.preventDefault();
    element.classList.add("is-target");
  });
  element.addEventListener("dragleave", () => element.classList.remove("is-target"));
  element.addEventListener("drop", (event) => {
    event.preventDefault();
    element.classList.remove("is-target");
    void upload([...(event.dataTransfer?.files ?? [])]);
  });

  /** @param {File[]} files */
  async function upload(files) {
    for (const file of files) {
      const path = folder ? `${folder}/${file.name}` : file.name;
      try {
        if (file.size > model.hello.value.limits.upload)
          throw new Error(t("load.toobig", { name: file.name, most: size(model.hello.value.limits.upload) }));
        await call(address("programs/upload", { path }), { method: "POST", body: file });
        report(t("load.uploaded", { name: file.name }));
      } catch (error) {
        refuse(error);
        return;
      }
    }
    await read(folder);
  }

  /** @param {string} where */
  async function read(where) {
    const listed = await newest(get("programs", { folder: where || undefined }));
    if (!listed) return;
    folder = listed.folder ?? where;
    place.textContent = `/${folder}`;
    const up = folder
      ? [
          {
            name: "..",
            path: folder.split("/").slice(0, -1).join("/"),
            kind: "folder",
            bytes: 0,
            changed: "",
            locked: false,
          },
        ]
      : [];
    fill(
      rows,
      ...[...up, ...listed.entries]
        .filter((/** @type {Entry} */ each) => each.kind === "folder" || kinds.includes(each.kind))
        .map(rowOf),
    );
  }

  /** @param {Entry} entry */
  function rowOf(entry) {
    const row = h(
      "button.key.item",
      {
        type: "button",
        role: "option",
        ariaSelected: "false",
        data: { path: entry.path },
        onclick: () => {
          if (entry.kind === "folder") {
            void read(entry.path).catch(refuse);
            return;
          }
          for (const each of rows.children) each.setAttribute("aria-selected", String(each === row));
          chosen(entry);
        },
        ondblclick: () => entry.kind === "folder" || opened(entry),
      },
      h("span", { ariaHidden: "true" }, entry.kind === "folder" ? "\u25b8" : "\u2002"),
      h("span.name", { title: entry.name }, entry.name),
      entry.locked ? h("span.quiet", {}, t("load.locked")) : "",
      entry.kind === "folder" ? "" : h("span.quiet.number", {}, size(entry.bytes)),
      h("span.quiet.number.file-date", {}, entry.changed.slice(0, 16).replace("T", " ")),
    );
    return row;
  }
  void read("").catch(refuse);
  return { element, read: () => read(folder) };
}
