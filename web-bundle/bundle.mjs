// Bundles the libraries of the panel's screens: `npm ci && npm run bundle` (or `make web-bundle`).
//
// Every file of entries/ becomes a minified ES module in src/openacr/panel/web/vendor, with a
// `.gz` sibling for servers, its types and the licences of the packages in it. manifest.json records the
// hashes of what went in and what came out; tests compare them without Node.
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";

const HERE = dirname(fileURLToPath(import.meta.url));
const OUT = join(HERE, "../src/openacr/panel/web/vendor");
const SHEETS = {
  "dockview.css": () => sheetWithin("dockview-core/dist/dockview-core.js", "light"),
  "uplot.css": () => read("node_modules/uplot/dist/uPlot.min.css").toString(),
  "xterm.css": () => read("node_modules/@xterm/xterm/css/xterm.css").toString(),
};
const INPUTS = ["package.json", "package-lock.json", "bundle.mjs"];

// The terminal writes its rules into style elements, which the policy of the panel's server forbids.
// It gets templates instead; screens/terminal.js makes the same rules a constructed sheet.
const CHANGES = { "xterm.js": ['createElement("style")', 'createElement("template")'] };

const read = (path) => readFileSync(join(HERE, path));
const hash = (data) => createHash("sha256").update(data).digest("hex");
const outputs = {};
const packages = new Set();

/** Write one file, and its compressed form with a fixed time stamp. */
function put(name, data) {
  const bytes = Buffer.from(data);
  const packed = gzipSync(bytes, { level: 9 });
  packed[9] = 255; // the operating system that packed it
  mkdirSync(dirname(join(OUT, name)), { recursive: true });
  writeFileSync(join(OUT, name), bytes);
  outputs[name] = hash(bytes);
  if (!/[.](js|css)$/.test(name)) return;
  writeFileSync(join(OUT, `${name}.gz`), packed);
  outputs[`${name}.gz`] = hash(packed);
}

/** The style sheet that a script carries as a text, with one of its themes. */
function sheetWithin(source, theme) {
  const text = /\.textContent = ("(?:[^"\\]|\\.)*")/.exec(read(`node_modules/${source}`).toString());
  if (!text) throw new Error(`${source} no longer carries a style sheet`);
  const other = new RegExp(`(?<=^|})[^{}]*\\.dockview-theme-(?!${theme}[ .{,\\n])[^{}]*{[^{}]*}`, "g");
  return JSON.parse(text[1]).replace(other, "");
}

/** The package a bundled file belongs to, e.g. "@codemirror/view". */
function packageOf(file) {
  const path = file.split("node_modules/").pop();
  const parts = path.split("/");
  return path.startsWith("@") ? parts.slice(0, 2).join("/") : parts[0];
}

rmSync(OUT, { recursive: true, force: true });
const entries = readdirSync(join(HERE, "entries")).sort();
for (const entry of entries) {
  const result = await build({
    absWorkingDir: HERE,
    entryPoints: [`entries/${entry}`],
    bundle: true,
    minify: true,
    format: "esm",
    target: "es2022",
    legalComments: "none",
    metafile: true,
    write: false,
    logLevel: "warning",
  });
  for (const file of Object.keys(result.metafile.inputs)) {
    if (file.includes("node_modules/")) packages.add(packageOf(file));
  }
  const text = result.outputFiles[0].text;
  const [before, after] = CHANGES[entry] ?? ["", ""];
  if (!text.includes(before)) throw new Error(`${entry} no longer has ${before}`);
  put(basename(entry), before ? text.replaceAll(before, after) : text);
}
for (const [name, source] of Object.entries(SHEETS)) {
  put(
    name,
    (await build({ stdin: { contents: source(), loader: "css" }, minify: true, write: false })).outputFiles[0].contents,
  );
}
for (const name of readdirSync(join(HERE, "types")).sort()) put(name, read(`types/${name}`));
const versions = {};
for (const name of [...packages].sort()) {
  const folder = `node_modules/${name}`;
  versions[name] = JSON.parse(read(`${folder}/package.json`)).version;
  const license = readdirSync(join(HERE, folder)).find((file) => /^licen[cs]e/i.test(file));
  put(`licenses/${name.replace("/", "__")}.txt`, read(`${folder}/${license}`));
}
const folders = ["entries", "types"];
const inputs = [...INPUTS];
for (const folder of folders) {
  inputs.push(
    ...readdirSync(join(HERE, folder))
      .sort()
      .map((name) => `${folder}/${name}`),
  );
}
// For the tests alone: the checker of accessibility, beside its licence.
const checker = join(HERE, "../tests/panel/browser/axe");
mkdirSync(checker, { recursive: true });
for (const name of ["axe.min.js", "LICENSE"]) {
  writeFileSync(join(checker, name), read(`node_modules/axe-core/${name}`));
}
const manifest = {
  packages: versions,
  inputs: Object.fromEntries(inputs.map((path) => [path, hash(read(path))])),
  outputs,
};
writeFileSync(join(OUT, "manifest.json"), `${JSON.stringify(manifest, null, 2)}\n`);
for (const name of Object.keys(outputs)) {
  if (name.endsWith(".gz")) console.log(name, readFileSync(join(OUT, name)).length);
}
