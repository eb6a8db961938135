// An image and its smaller ones, each of half the size: means of 2 x 2 texels of the one before, in linear light. Where texels have
// opacities, their colours count by these: a level has the colour of what is there, and the mean opacity.

import { bytesOf, LINEAR, type Image } from "./image";

/** Red, green, blue and, if the image has any, opacity of each texel: sRGB bytes, or reflectance and opacity of which 65535 is 1. */
export interface Level {
  columns: number;
  rows: number;
  hasOpacity: boolean;
  bands: Uint8Array | Uint16Array;
}

const ONE = 65535; // sixteen bits keep the darkest sRGB bytes apart, by 20 and more

const WORD_OF_OPACITY = 257; // 255 of a byte is 65535

const WORDS = Uint16Array.from(LINEAR, (x) => Math.round(ONE * x));

/** Sizes halve rounded up: no level leaves out a texel. */
export const halfOf = (size: number) => (size + 1) >> 1;

/** Returns how many texels the levels of an image have together. */
export function texelsOf({ columns, rows }: { columns: number; rows: number }): number {
  return columns * rows + (columns === 1 && rows === 1 ? 0 : texelsOf({ columns: halfOf(columns), rows: halfOf(rows) }));
}

/** The image itself first, one texel last. */
export function* levelsOf(image: Image): Generator<Level> {
  const { columns, rows, hasOpacity, texels } = image;
  let level: Level = { columns, rows, hasOpacity, bands: texels };
  yield level;
  while (level.columns > 1 || level.rows > 1) yield (level = halved(level));
}

/** The last column and row of odd sizes count twice. */
function halved(level: Level): Level {
  const columns = halfOf(level.columns);
  const rows = halfOf(level.rows);
  const stride = bytesOf(level);
  const meansOf = level.hasOpacity ? writeMeansOfThere : writeMeans;
  const bands = new Uint16Array(stride * columns * rows);
  for (let row = 0; row < rows; ++row) {
    const upper = wordsOf(level, 2 * row);
    const lower = wordsOf(level, Math.min(2 * row + 1, level.rows - 1));
    meansOf(upper, lower, bands.subarray(stride * columns * row, stride * columns * (row + 1)));
  }
  return { columns, rows, hasOpacity: level.hasOpacity, bands };
}

/** Returns a row of a level, in linear light. */
function wordsOf({ columns, hasOpacity, bands }: Level, row: number): Uint16Array {
  const stride = bytesOf({ hasOpacity });
  const its = bands.subarray(stride * columns * row, stride * columns * (row + 1));
  if (its instanceof Uint16Array) return its;
  const words = new Uint16Array(its.length);
  for (let n = 0; n < its.length; ++n) words[n] = WORDS[its[n]];
  if (hasOpacity) for (let n = 3; n < its.length; n += 4) words[n] = WORD_OF_OPACITY * its[n];
  return words;
}

function writeMeans(upper: Uint16Array, lower: Uint16Array, out: Uint16Array): void {
  const last = upper.length - 3;
  for (let n = 0; n < out.length; n += 3)
    for (let band = 0; band < 3; ++band) {
      const left = 2 * n + band;
      const right = Math.min(2 * n + 3, last) + band;
      out[n + band] = (upper[left] + upper[right] + lower[left] + lower[right] + 2) >> 2;
    }
}

/** Of texels with opacities. The colour of holes alone is 0. */
function writeMeansOfThere(upper: Uint16Array, lower: Uint16Array, out: Uint16Array): void {
  const last = upper.length - 4;
  for (let n = 0; n < out.length; n += 4) {
    const left = 2 * n;
    const right = Math.min(left + 4, last);
    const opacities = [upper[left + 3], upper[right + 3], lower[left + 3], lower[right + 3]];
    const there = opacities[0] + opacities[1] + opacities[2] + opacities[3];
    out[n + 3] = (there + 2) >> 2;
    if (there === 0) continue;
    for (let band = 0; band < 3; ++band) {
      const above = opacities[0] * upper[left + band] + opacities[1] * upper[right + band];
      const below = opacities[2] * lower[left + band] + opacities[3] * lower[right + band];
      out[n + band] = Math.round((above + below) / there);
    }
  }
}

/** Returns the byte of an opacity of a Level. */
export const byteOfOpacity = (word: number) => Math.round(word / WORD_OF_OPACITY);

/** Returns the sRGB byte of each reflectance of a Level. */
export function encoding(): Uint8Array {
  return Uint8Array.from({ length: ONE + 1 }, (_, word) => Math.round(255 * encoded(word / ONE)));
}

function encoded(x: number): number {
  return x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
}
