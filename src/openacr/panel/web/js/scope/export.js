// Records of the scope as files: CSV and PNG are made here, Parquet by the server.
import { address, call } from "../core/api.js";
import { model, refuse } from "../core/app.js";
import { h } from "../core/dom.js";
import { t } from "../core/texts.js";
import { ask } from "../frame/dialog.js";
import { fullLabel } from "./channels.js";

/**
 * @typedef {import("./channels.js").Channel} Channel
 */

/**
 * Traces as CSV: time in s, then every trace in full precision; a missing sample is empty.
 * @param {Channel[]} traces
 * @param {number} period s
 * @param {number} begin s of the first sample
 */
function csvOf(traces, period, begin) {
  const quoted = (/** @type {string} */ text) => (/[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);
  const lines = [["time_s", ...traces.map(fullLabel)].map(quoted).join(",")];
  for (let n = 0; n < (traces[0]?.values.length ?? 0); n++) {
    lines.push(
      [
        Number((begin + n * period).toPrecision(12)),
        ...traces.map(({ values }) => (Number.isNaN(values[n]) ? "" : values[n])),
      ].join(","),
    );
  }
  return `${lines.join("\n")}\n`;
}

/**
 * Traces as Parquet; the server's refusal is thrown.
 * @param {Channel[]} traces
 * @param {number} period s
 * @param {number} begin s of the first sample
 */
async function parquetOf(traces, period, begin) {
  const samples = traces[0]?.values.length ?? 0;
  const body = new Float64Array(samples * traces.length);
  traces.forEach(({ values }, n) => body.set(values, n * samples));
  const query = { names: JSON.stringify(traces.map(fullLabel)), period_s: period, begin_s: begin };
  return (
    await call(address("scope/parquet", query), {
      method: "POST",
      headers: { "Content-Type": "application/octet-stream" },
      body,
    })
  ).blob();
}

/**
 * A picture of a canvas on the colour it lies on, with lines of text below it.
 * @param {HTMLCanvasElement} canvas
 * @param {{ text: string, color?: string }[]} lines a colour is a key of the text
 * @returns {Promise<Blob>}
 */
function pngOf(canvas, lines) {
  const size = 13 * devicePixelRatio;
  const row = 1.5 * size;
  const copy = h("canvas", {});
  const ctx = /** @type {CanvasRenderingContext2D} */ (copy.getContext("2d"));
  const font = `${size}px sans-serif`;
  ctx.font = font;
  copy.width = Math.max(canvas.width, ...lines.map(({ text }) => ctx.measureText(text).width + 3 * size));
  copy.height = canvas.height + (lines.length + 0.5) * row;
  const style = getComputedStyle(document.body);
  ctx.fillStyle = style.backgroundColor;
  ctx.fillRect(0, 0, copy.width, copy.height);
  ctx.drawImage(canvas, 0, 0);
  ctx.font = font; // a canvas forgets it with its size
  lines.forEach(({ text, color }, n) => {
    const y = canvas.height + (n + 1) * row;
    if (color) {
      ctx.fillStyle = color;
      ctx.fillRect(size / 2, y - 0.8 * size, size, 0.9 * size);
    }
    ctx.fillStyle = style.color;
    ctx.fillText(text, 2 * size, y);
  });
  return new Promise((resolve, reject) =>
    copy.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("no picture"))), "image/png"),
  );
}

/**
 * The name of a file with its time: two records of different days can be told apart.
 * @param {string} kind
 * @param {Date} now
 */
export function fileName(kind, now) {
  const two = (/** @type {number} */ n) => String(n).padStart(2, "0");
  const day = [now.getFullYear(), two(now.getMonth() + 1), two(now.getDate())].join("-");
  return `scope-${day}-${two(now.getHours())}${two(now.getMinutes())}${two(now.getSeconds())}.${kind}`;
}

/**
 * Have the browser keep a file.
 * @param {string} name
 * @param {Blob} blob
 */
function keepFile(name, blob) {
  const link = h("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

/**
 * Ask for the kind of a file, and keep what is shown as one.
 * @param {{ traces: Channel[], period: number, begin: number, canvas: HTMLCanvasElement | null | undefined,
 *   trigger: any }} shown s
 * @param {string} [part] another text, where the server makes the files
 * @param {((kind: "csv" | "parquet") => string) | null} [addressOf] their addresses
 */
export async function exportAs(
  { traces, period, begin, canvas, trigger },
  part = t("scope.export.text"),
  addressOf = null,
) {
  const kind = await ask({
    title: t("scope.export"),
    body: [h("p", {}, part)],
    choices: ["csv", "parquet", "png"].map((each) => ({ text: each.toUpperCase(), value: each })),
  });
  if (addressOf && kind === "csv") {
    h("a", { href: addressOf(kind), download: "" }).click();
    return;
  }
  const now = new Date();
  try {
    if (addressOf && kind === "parquet") {
      keepFile(fileName(kind, now), await (await call(addressOf(kind))).blob()); // a refusal is said
      return;
    }
    if (kind && kind !== "png" && !traces.length) throw new Error(t("scope.export.none"));
    if (kind === "csv") keepFile(fileName(kind, now), new Blob([csvOf(traces, period, begin)], { type: "text/csv" }));
    else if (kind === "parquet") keepFile(fileName(kind, now), await parquetOf(traces, period, begin));
    else if (kind && canvas) keepFile(fileName(kind, now), await pngOf(canvas, legendOf(traces, period, trigger, now)));
  } catch (error) {
    refuse(error);
  }
}

/**
 * What a picture shows, in words.
 * @param {Channel[]} traces
 * @param {number} period s
 * @param {any} trigger
 * @param {Date} now
 */
function legendOf(traces, period, trigger, now) {
  const title = [
    `${model.hello.value.machine.name} ${model.hello.value.machine.card}`.trim(),
    now.toLocaleString(),
    `${t("scope.period")} ${1000 * period}`,
    ...(trigger ? [`T: ${trigger.channel} ${trigger.level} ${t(/** @type {any} */ (`scope.${trigger.slope}`))}`] : []),
  ];
  return [
    { text: title.join(", ") },
    ...traces.map((each) => ({
      text: t("scope.legend", { name: fullLabel(each), scale: each.scale, offset: each.offset }),
      color: each.color,
    })),
  ];
}
