// An image and its smaller ones, each of half the size: means of 2 x 2 texels of the one before, in linear light.

import { LINEAR, type Image } from "./image";

/** Red, green and blue of each texel: sRGB bytes, or reflectance of which 65535 is 1. */
export interface Level {
  columns: number;
  rows: number;
  bands: Uint8Array | Uint16Array;
}

const ONE = 65535; // sixteen bits keep the darkest sRGB bytes apart, by 20 and more

const WORDS = Uint16Array.from(LINEAR, (x) => Math.round(ONE * x));

/** Sizes halve rounded up: no level leaves out a texel. */
export const halfOf = (size: number) => (size + 1) >> 1;

/** Returns how many texels the levels of an image have together. */
export function texelsOf({ columns, rows }: { columns: number; rows: number }): number {
  return columns * rows + (columns === 1 && rows === 1 ? 0 : texelsOf({ columns: halfOf(columns), rows: halfOf(rows) }));
}

/** The image itself first, one texel last. */
export function* levelsOf(image: Image): Generator<Level> {
  let level: Level = { columns: image.columns, rows: image.rows, bands: image.texels };
  yield level;
  while (level.columns > 1 || level.rows > 1) yield (level = halved(level));
}

/** The last column and row of odd sizes count twice. */
function halved(level: Level): Level {
  const columns = halfOf(level.columns);
  const rows = halfOf(level.rows);
  const bands = new Uint16Array(3 * columns * rows);
  for (let row = 0; row < rows; ++row) {
    const upper = wordsOf(level, 2 * row);
    const lower = wordsOf(level, Math.min(2 * row + 1, level.rows - 1));
    meansOf(upper, lower, bands.subarray(3 * columns * row, 3 * columns * (row + 1)));
  }
  return { columns, rows, bands };
}

/** Returns a row of a level, in linear light. */
function wordsOf({ columns, bands }: Level, row: number): Uint16Array {
  const its = bands.subarray(3 * columns * row, 3 * columns * (row + 1));
  if (its instanceof Uint16Array) return its;
  const words = new Uint16Array(its.length);
  for (let n = 0; n < its.length; ++n) words[n] = WORDS[its[n]];
  return words;
}

function meansOf(upper: Uint16Array, lower: Uint16Array, out: Uint16Array): void {
  const last = upper.length - 3;
  for (let n = 0; n < out.length; n += 3)
    for (let band = 0; band < 3; ++band) {
      const left = 2 * n + band;
      const right = Math.min(2 * n + 3, last) + band;
      out[n + band] = (upper[left] + upper[right] + lower[left] + lower[right] + 2) >> 2;
    }
}

/** Returns the sRGB byte of each reflectance of a Level. */
export function encoding(): Uint8Array {
  return Uint8Array.from({ length: ONE + 1 }, (_, word) => Math.round(255 * encoded(word / ONE)));
}

function encoded(x: number): number {
  return x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
}
