// Numbers and times as the screens show them.

const MINUS = "\u2212";

/**
 * A position with fixed decimals and always a place for its sign.
 * @param {number} value
 * @param {number} decimals
 */
export function position(value, decimals) {
  if (!Number.isFinite(value)) return "\u2013";
  const text = Math.abs(value).toFixed(decimals);
  return (value < 0 && Number(text) !== 0 ? MINUS : "\u2007") + text;
}

/**
 * @param {number} value
 * @param {number} [decimals]
 */
export function plain(value, decimals = 0) {
  if (!Number.isFinite(value)) return "\u2013";
  const text = value.toFixed(decimals);
  return (Number(text) === 0 ? text.replace("-", "") : text).replace("-", MINUS);
}

/** @param {number} seconds */
export function duration(seconds) {
  if (!Number.isFinite(seconds)) return "\u2013";
  const whole = Math.max(0, Math.round(seconds));
  const two = (/** @type {number} */ n) => String(n).padStart(2, "0");
  const [hours, minutes] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60];
  return hours ? `${hours}:${two(minutes)}:${two(whole % 60)}` : `${minutes}:${two(whole % 60)}`;
}

/** @param {number} bytes */
export function size(bytes) {
  if (bytes < 1024) return `${bytes} B`;
  return bytes < 1048576 ? `${(bytes / 1024).toFixed(1)} kB` : `${(bytes / 1048576).toFixed(1)} MB`;
}
