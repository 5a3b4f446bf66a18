// Records of the scope as files: CSV and PNG are made here, Parquet by the server.
import { address, call } from "../core/api.js";
import { h } from "../core/dom.js";

/**
 * @typedef {import("./channels.js").Channel} Channel
 */

/** @param {Channel} trace */
function columnOf({ label, unit }) {
  return unit ? `${label} [${unit}]` : label;
}

/**
 * Traces as CSV: time in s, then every trace in full precision; a missing sample is empty.
 * @param {Channel[]} traces
 * @param {number} period s
 */
export function csvOf(traces, period) {
  const quoted = (/** @type {string} */ text) => (/[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);
  const lines = [["time_s", ...traces.map(columnOf)].map(quoted).join(",")];
  for (let n = 0; n < (traces[0]?.values.length ?? 0); n++) {
    lines.push([Number((n * period).toPrecision(12)), ...traces.map(({ values }) => (Number.isNaN(values[n]) ? "" : values[n]))].join(","));
  }
  return `${lines.join("\n")}\n`;
}

/**
 * Traces as Parquet; the server's refusal is thrown.
 * @param {Channel[]} traces
 * @param {number} period s
 */
export async function parquetOf(traces, period) {
  const samples = traces[0]?.values.length ?? 0;
  const body = new Float64Array(samples * traces.length);
  traces.forEach(({ values }, n) => body.set(values, n * samples));
  const query = { names: JSON.stringify(traces.map(columnOf)), period_s: period };
  return (await call(address("scope/parquet", query), { method: "POST", headers: { "Content-Type": "application/octet-stream" }, body })).blob();
}

/**
 * A picture of a canvas on the colour it lies on.
 * @param {HTMLCanvasElement} canvas
 * @returns {Promise<Blob>}
 */
export function pngOf(canvas) {
  const copy = h("canvas", { width: canvas.width, height: canvas.height });
  const ctx = /** @type {CanvasRenderingContext2D} */ (copy.getContext("2d"));
  ctx.fillStyle = getComputedStyle(document.body).getPropertyValue("background-color");
  ctx.fillRect(0, 0, copy.width, copy.height);
  ctx.drawImage(canvas, 0, 0);
  return new Promise((resolve, reject) => copy.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("no picture"))), "image/png"));
}

/**
 * Have the browser keep a file.
 * @param {string} name
 * @param {Blob} blob
 */
export function keepFile(name, blob) {
  const link = h("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}
