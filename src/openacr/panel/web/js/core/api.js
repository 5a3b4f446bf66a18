// HTTP calls; a refusal of the server is thrown with its own text.
import { t } from "./texts.js";

/** An answer with an error; `body` is the whole answer. Status 0: no answer. */
export class ApiError extends Error {
  /**
   * @param {number} status
   * @param {any} body
   */
  constructor(status, body) {
    super(body?.error?.text ?? t(status === 0 ? "api.lost" : status === 404 ? "api.unknown" : "api.failed"));
    this.status = status;
    this.body = body;
  }
}

/**
 * @param {string} path
 * @param {Record<string, string | number | undefined>} [query]
 */
export function address(path, query = {}) {
  const parts = Object.entries(query).filter(([, value]) => value !== undefined);
  const text = new URLSearchParams(parts.map(([name, value]) => [name, String(value)])).toString();
  return `/api/${path}${text ? `?${text}` : ""}`;
}

/**
 * @param {string} url
 * @param {RequestInit} [options]
 */
export async function call(url, options = {}) {
  const response = await fetch(url, { credentials: "same-origin", ...options }).catch(() => null);
  if (!response) throw new ApiError(0, null);
  if (!response.ok) throw new ApiError(response.status, await response.json().catch(() => null));
  return response;
}

/**
 * @param {string} path
 * @param {Record<string, string | number | undefined>} [query]
 * @returns {Promise<any>}
 */
export async function get(path, query) {
  return (await call(address(path, query))).json();
}

/**
 * Replies may arrive in another order than they were asked for: of those that pass the function that is returned, the
 * newest counts.
 * One that another was asked for after, or that arrives after the end, is undefined, also where it is a refusal.
 * @param {import("./signal.js").Endings} [endings]
 * @returns {<T>(reply: Promise<T>) => Promise<T | undefined>}
 */
export function latest(endings) {
  let count = 0;
  endings?.add(() => {
    count += 1;
  });
  return async (reply) => {
    const mine = ++count;
    try {
      const found = await reply;
      return mine === count ? found : undefined;
    } catch (error) {
      if (mine === count) throw error;
      return undefined;
    }
  };
}

/**
 * @param {string} method
 * @param {string} path
 * @param {object} body
 * @param {Record<string, string | number | undefined>} [query]
 * @returns {Promise<any>}
 */
export async function send(method, path, body, query) {
  const headers = { "Content-Type": "application/json" };
  return (await call(address(path, query), { method, headers, body: JSON.stringify(body) })).json();
}

/**
 * The text of a file with its version.
 * @param {string} path
 */
export async function readFile(path) {
  const response = await call(address("programs/file", { path }));
  return { text: await response.text(), version: (response.headers.get("ETag") ?? "").replace(/^(W\/)?"|"$/g, "") };
}

/**
 * @param {string} path
 * @param {string} text
 * @param {string | null} version of the file that is replaced; null for a new one
 */
export async function writeFile(path, text, version) {
  /** @type {Record<string, string>} */
  const headers = { "Content-Type": "text/plain; charset=utf-8" };
  if (version !== null) headers["If-Match"] = version;
  return (await call(address("programs/file", { path }), { method: "PUT", headers, body: text })).json();
}
