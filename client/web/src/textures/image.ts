// The images of textures, and the reflectance that they give to a place.

import { Texture_Wrap, type ReadImagesResponse, type Texture } from "../gen/alvor/v1/scene_service_pb";

/** Red, green and blue of each texel, sRGB, row by row from the top; after blue its opacity, if the image has any. */
export interface Image {
  columns: number;
  rows: number;
  /** Texels have a fourth byte: 255 is all there, 0 is a hole. */
  hasOpacity: boolean;
  texels: Uint8Array;
}

/** Returns how many bytes a texel has. */
export const bytesOf = ({ hasOpacity }: { hasOpacity: boolean }) => (hasOpacity ? 4 : 3);

const BRIGHTEST = 254; // what reflects everything would never grow dark: GeometryChunk.texels

/** By byte of a texel: its reflectance (IEC 61966-2-1). */
export const LINEAR = Float64Array.from({ length: 256 }, (_, byte) => linearOf(Math.min(byte, BRIGHTEST) / 255));

function linearOf(x: number): number {
  return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
}

/** Texels as they come, of one image after the other and cut anywhere, put together again. */
export class ImageCollector {
  readonly images: Image[] = [];
  private filling = 0; // the image to which the next texel belongs
  private filled = 0; // bytes of it that are there

  /** Throws on texels that belong to no image. */
  take({ images, texels }: Pick<ReadImagesResponse, "images" | "texels">): void {
    for (const { columns, rows, hasOpacity } of images)
      this.images.push({ columns, rows, hasOpacity, texels: new Uint8Array(bytesOf({ hasOpacity }) * columns * rows) });
    for (let from = 0; from < texels.length; ) {
      const image = this.images[this.filling];
      if (!image) throw new Error("there are more texels than the images have");
      const count = Math.min(texels.length - from, image.texels.length - this.filled);
      image.texels.set(texels.subarray(from, from + count), this.filled);
      from += count;
      this.filled += count;
      if (this.filled < image.texels.length) return;
      this.filling += 1;
      this.filled = 0;
    }
  }

  get isWhole(): boolean {
    return this.filling === this.images.length;
  }
}

/** Returns the texel that stands for texel `n` of a row or column of `count`, which may lie beyond its ends. */
export function wrapped(n: number, count: number, wrap: Texture_Wrap): number {
  if (wrap === Texture_Wrap.CLAMP) return Math.min(count - 1, Math.max(0, n));
  const modulo = (period: number) => ((n % period) + period) % period;
  if (wrap !== Texture_Wrap.MIRROR) return modulo(count);
  const there = modulo(2 * count);
  return there < count ? there : 2 * count - 1 - there;
}

/**
 * Returns the reflectance at (s, t) of what is there, bilinear between the middles of texels; 0 if nothing is there. The shaders of view/ do
 * the same.
 */
export function reflectanceAt(image: Image, texture: Texture, s: number, t: number): [number, number, number] {
  const x = s * image.columns - 0.5;
  const y = t * image.rows - 0.5;
  const [column, row] = [Math.floor(x), Math.floor(y)];
  const sum: [number, number, number] = [0, 0, 0];
  let there = 0;
  for (const [n, shareX] of [[column, column + 1 - x], [column + 1, x - column]])
    for (const [m, shareY] of [[row, row + 1 - y], [row + 1, y - row]]) {
      const texel = texelAt(image, texture, n, m);
      const weight = shareX * shareY * opacityOf(image, texel);
      for (let band = 0; band < 3; ++band) sum[band] += weight * LINEAR[image.texels[texel + band]];
      there += weight;
    }
  if (!(there > 0)) return [0, 0, 0];
  const scale = image.hasOpacity ? 1 / there : 1;
  const [r, g, b] = factorOf(texture);
  return [r * scale * sum[0], g * scale * sum[1], b * scale * sum[2]];
}

/** Returns which share of the surface is there at (s, t): the opacity of the texel there, so that outlines are sharp. */
export function opacityAt(image: Image, texture: Texture, s: number, t: number): number {
  return opacityOf(image, texelAt(image, texture, Math.floor(s * image.columns), Math.floor(t * image.rows)));
}

/** Returns where the bytes begin of the texel that is seen in a column and a row, which may lie beyond the image. */
function texelAt(image: Image, texture: Texture, column: number, row: number): number {
  return bytesOf(image) * (wrapped(row, image.rows, texture.wrapT) * image.columns + wrapped(column, image.columns, texture.wrapS));
}

function opacityOf({ hasOpacity, texels }: Image, texel: number): number {
  return hasOpacity ? texels[texel + 3] / 255 : 1;
}

export function factorOf({ factor }: Texture): [number, number, number] {
  return factor ? [factor.r, factor.g, factor.b] : [1, 1, 1];
}
