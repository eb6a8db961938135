// Textures count by their mean colour, as in import/texture_colour.cpp: a patch has one reflectance and one emission.

import { isPng, sumOfPng } from "./png";
import { linearTable } from "./srgb";

export type Bands = [number, number, number];

export const isZero = (bands: Bands) => bands.every((band) => band === 0);

// A file of some kilobytes can ask for any number of pixels.
export const MOST_PIXELS = 2 ** 28;
const TILE = 1024; // pixels of a canvas's side: browsers limit canvases

/** Returns the mean of an encoded image's pixels, linearised from sRGB, without alpha; undefined if it cannot be decoded. */
export async function meanColour(encoded: Uint8Array<ArrayBuffer>): Promise<Bands | undefined> {
  try {
    if (isPng(encoded)) return mean(await sumOfPng(encoded, MOST_PIXELS));
    return isForBrowser(encoded) ? mean(await sumByBrowser(encoded)) : undefined;
  } catch {
    return undefined;
  }
}

/** Returns `factor` under a texture of this mean colour; `texture` names it in the warning. */
export function textured(factor: Bands, colour: Bands | undefined, texture: string, warnings: string[]): Bands {
  warnings.push(texture + (colour ? " counts by its mean colour" : " cannot be read and is left out"));
  return colour ? (factor.map((band, n) => band * colour[n]) as Bands) : factor;
}

export interface PixelSum {
  sum: Bands;
  count: number;
}

const mean = ({ sum, count }: PixelSum) => sum.map((band) => band / count) as Bands;

/** JPEG, GIF and BMP: of what browsers decode, what `alvor` decodes too. */
function isForBrowser(encoded: Uint8Array): boolean {
  const starts = (...bytes: number[]) => bytes.every((byte, n) => encoded[n] === byte);
  return starts(0xff, 0xd8, 0xff) || starts(0x47, 0x49, 0x46, 0x38) || starts(0x42, 0x4d);
}

async function sumByBrowser(encoded: Uint8Array<ArrayBuffer>): Promise<PixelSum> {
  const picture = await createImageBitmap(new Blob([encoded]), { colorSpaceConversion: "none" });
  const { width, height } = picture;
  if (width * height > MOST_PIXELS) throw new Error("too large");
  const pen = new OffscreenCanvas(TILE, TILE).getContext("2d", { willReadFrequently: true })!;
  const linear = linearTable(255);
  const sum: Bands = [0, 0, 0];
  for (let y = 0; y < height; y += TILE)
    for (let x = 0; x < width; x += TILE) {
      pen.drawImage(picture, -x, -y);
      const { data } = pen.getImageData(0, 0, Math.min(TILE, width - x), Math.min(TILE, height - y));
      for (let n = 0; n < data.length; n += 4) for (let band = 0; band < 3; ++band) sum[band] += linear[data[n + band]];
    }
  picture.close();
  return { sum, count: width * height };
}
