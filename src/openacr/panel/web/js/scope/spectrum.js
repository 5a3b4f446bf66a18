// The spectrum of a record of any length: amplitudes in the unit of the channel, by the discrete Fourier transform.

/** Cosine terms of the windows, periodic: a0 - a1 cos(x) + a2 cos(2x) - ... */
const TERMS = Object.freeze({
  rectangle: [1],
  hann: [0.5, 0.5],
  hamming: [0.54, 0.46],
  blackman: [0.42, 0.5, 0.08],
  flattop: [0.21557895, 0.41663158, 0.277263158, 0.083578947, 0.006947368],
});
export const WINDOWS = Object.freeze(Object.keys(TERMS));

/**
 * @param {string} name
 * @param {number} length
 */
export function windowOf(name, length) {
  const terms = TERMS[/** @type {keyof typeof TERMS} */ (name)];
  return Float64Array.from({ length }, (_each, n) =>
    terms.reduce((sum, term, k) => sum + (k % 2 ? -term : term) * Math.cos((2 * Math.PI * k * n) / length), 0),
  );
}

/**
 * Amplitudes from 0 Hz to half the sampling rate; a sine of amplitude A at a bin has A there. Null for a record with a
 * gap.
 * @param {ArrayLike<number>} values
 * @param {number} period s
 * @param {string} name of the window
 * @returns {{ step: number, amplitudes: Float64Array } | null} `step`: Hz from bin to bin
 */
export function spectrum(values, period, name) {
  const size = values.length;
  if (size < 2 || Array.prototype.some.call(values, Number.isNaN)) return null;
  const weights = windowOf(name, size);
  const gain = weights.reduce((sum, weight) => sum + weight, 0);
  const [real, imaginary] = transformed(
    weights.map((weight, n) => weight * values[n]),
    new Float64Array(size),
  );
  const amplitudes = Float64Array.from({ length: Math.floor(size / 2) + 1 }, (_each, n) => {
    const isSingle = n === 0 || 2 * n === size;
    return ((isSingle ? 1 : 2) * Math.hypot(real[n], imaginary[n])) / gain;
  });
  return { step: 1 / (size * period), amplitudes };
}

/** @param {number} amplitude of 1 unit: 0 dB */
export function decibels(amplitude) {
  return 20 * Math.log10(Math.max(amplitude, 1e-15));
}

/**
 * The bins above both of their neighbours, the highest first, without that of 0 Hz.
 * @param {Float64Array} amplitudes
 * @param {number} most
 */
export function peaks(amplitudes, most) {
  const found = [];
  for (let n = 1; n < amplitudes.length - 1; n++)
    if (amplitudes[n] > amplitudes[n - 1] && amplitudes[n] > amplitudes[n + 1]) found.push(n);
  return found.sort((a, b) => amplitudes[b] - amplitudes[a]).slice(0, most);
}

/**
 * The discrete Fourier transform; lengths that are no power of two by the method of Bluestein.
 * @param {Float64Array} real
 * @param {Float64Array} imaginary
 * @returns {[Float64Array, Float64Array]}
 */
export function transformed(real, imaginary) {
  const size = real.length;
  if ((size & (size - 1)) === 0) return ofPowerOfTwo(real, imaginary);
  const [cosine, sine] = [new Float64Array(size), new Float64Array(size)];
  for (let n = 0; n < size; n++) {
    const angle = (Math.PI * ((n * n) % (2 * size))) / size; // reduced: n squared is large
    [cosine[n], sine[n]] = [Math.cos(angle), Math.sin(angle)];
  }
  const length = 2 ** Math.ceil(Math.log2(2 * size - 1));
  const [a, b, c, d] = [0, 0, 0, 0].map(() => new Float64Array(length));
  for (let n = 0; n < size; n++) {
    a[n] = real[n] * cosine[n] + imaginary[n] * sine[n];
    b[n] = imaginary[n] * cosine[n] - real[n] * sine[n];
    c[n] = c[(length - n) % length] = cosine[n];
    d[n] = d[(length - n) % length] = sine[n];
  }
  const [p, q] = ofPowerOfTwo(a, b);
  const [r, s] = ofPowerOfTwo(c, d);
  // The inverse transform is the transform with both parts exchanged.
  const [y, x] = ofPowerOfTwo(
    p.map((_each, n) => p[n] * s[n] + q[n] * r[n]),
    p.map((_each, n) => p[n] * r[n] - q[n] * s[n]),
  );
  return [
    cosine.map((_each, n) => (x[n] * cosine[n] + y[n] * sine[n]) / length),
    cosine.map((_each, n) => (y[n] * cosine[n] - x[n] * sine[n]) / length),
  ];
}

/**
 * @param {Float64Array} real
 * @param {Float64Array} imaginary
 * @returns {[Float64Array, Float64Array]}
 */
function ofPowerOfTwo(real, imaginary) {
  const size = real.length;
  const [x, y] = [new Float64Array(size), new Float64Array(size)];
  for (let n = 0, turned = 0; n < size; n++) {
    [x[turned], y[turned]] = [real[n], imaginary[n]];
    let bit = size >> 1;
    for (; turned & bit; bit >>= 1) turned ^= bit;
    turned |= bit;
  }
  for (let half = 1; half < size; half *= 2) {
    for (let k = 0; k < half; k++) {
      const [cosine, sine] = [Math.cos((Math.PI * k) / half), -Math.sin((Math.PI * k) / half)];
      for (let n = k; n < size; n += 2 * half) {
        const m = n + half;
        const [re, im] = [x[m] * cosine - y[m] * sine, x[m] * sine + y[m] * cosine];
        [x[m], y[m]] = [x[n] - re, y[n] - im];
        [x[n], y[n]] = [x[n] + re, y[n] + im];
      }
    }
  }
  return [x, y];
}
