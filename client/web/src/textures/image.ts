// The images of textures, and the reflectance that they give to a place.

import { Texture_Wrap, type ReadImagesResponse, type Texture } from "../gen/alvor/v1/scene_service_pb";

/** Red, green and blue of each texel, sRGB, row by row from the top. */
export interface Image {
  columns: number;
  rows: number;
  texels: Uint8Array;
}

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
    for (const { columns, rows } of images) this.images.push({ columns, rows, texels: new Uint8Array(3 * columns * rows) });
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

/** Returns the reflectance at (s, t), bilinear between the middles of texels. The shaders of view/ do the same. */
export function reflectanceAt(image: Image, texture: Texture, s: number, t: number): [number, number, number] {
  const x = s * image.columns - 0.5;
  const y = t * image.rows - 0.5;
  const [column, row] = [Math.floor(x), Math.floor(y)];
  const sum: [number, number, number] = [0, 0, 0];
  for (const [n, shareX] of [[column, column + 1 - x], [column + 1, x - column]])
    for (const [m, shareY] of [[row, row + 1 - y], [row + 1, y - row]]) {
      const texel = 3 * (wrapped(m, image.rows, texture.wrapT) * image.columns + wrapped(n, image.columns, texture.wrapS));
      for (let band = 0; band < 3; ++band) sum[band] += shareX * shareY * LINEAR[image.texels[texel + band]];
    }
  const [r, g, b] = factorOf(texture);
  return [r * sum[0], g * sum[1], b * sum[2]];
}

export function factorOf({ factor }: Texture): [number, number, number] {
  return factor ? [factor.r, factor.g, factor.b] : [1, 1, 1];
}
