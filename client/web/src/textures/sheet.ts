// All images with their pyramids on one sheet, texel after texel and row after row, as the graphics card gets them.

import { Texture_Wrap, type Material } from "../gen/alvor/v1/scene_service_pb";
import { bytesOf, factorOf, type Image } from "./image";
import { byteOfOpacity, encoding, levelsOf, texelsOf, type Level } from "./pyramid";

export interface Sheet {
  /** Texels of a row. */
  width: number;
  height: number;
}

/** Some whole rows of a sheet: r, g, b of each texel, sRGB, and its opacity, which is 255 where the image has none. */
export interface Piece {
  row: number;
  texels: Uint8Array<ArrayBuffer>;
}

const WIDTH = 4096; // hardly a graphics card has less
const PIECE_TEXELS = 1 << 21; // 8 MB

/** Returns a sheet that holds the images, of no side longer than `longest`; undefined if there is none. */
export function sheetFor(images: Image[], longest: number): Sheet | undefined {
  const total = images.reduce((sum, image) => sum + texelsOf(image), 0);
  for (const width of [Math.min(WIDTH, longest), longest]) {
    const height = Math.ceil(total / width);
    if (height > 0 && height <= longest) return { width, height };
  }
  return undefined;
}

/** What the texels behind the last image are does not matter. */
export function* piecesOf(images: Image[], { width, height }: Sheet): Generator<Piece> {
  const bytes = encoding();
  const most = Math.max(1, Math.floor(PIECE_TEXELS / width));
  const begin = (row: number): Piece => ({ row, texels: new Uint8Array(4 * width * Math.min(most, height - row)) });
  let piece = begin(0);
  let at = 0;
  for (const image of images)
    for (const level of levelsOf(image))
      for (let from = 0; from < level.columns * level.rows; ) {
        const count = Math.min(level.columns * level.rows - from, (piece.texels.length - at) / 4);
        writeTexels(level, from, count, bytes, piece.texels, at);
        from += count;
        at += 4 * count;
        if (at < piece.texels.length) continue;
        const next = piece.row + at / 4 / width;
        yield piece;
        piece = begin(next);
        at = 0;
      }
  if (piece.texels.length > 0) yield piece;
}

/** Writes `count` texels of a level from texel `from` on to `out[at]`. `bytes`: of encoding(). */
function writeTexels({ hasOpacity, bands }: Level, from: number, count: number, bytes: Uint8Array, out: Uint8Array, at: number): void {
  const isEncoded = bands instanceof Uint8Array;
  const stride = bytesOf({ hasOpacity });
  for (let n = stride * from; n < stride * (from + count); n += stride, at += 4) {
    for (let band = 0; band < 3; ++band) out[at + band] = isEncoded ? bands[n + band] : bytes[bands[n + band]];
    out[at + 3] = !hasOpacity ? 255 : isEncoded ? bands[n + 3] : byteOfOpacity(bands[n + 3]);
  }
}

/** Numbers of each material in a table: first texel, columns, rows, wraps; and the bits of three floats, the factor, and 0. */
export const TABLE_WORDS = 8;

/** Returns where on the sheet each material's image lies; columns are 0 for a material without one. */
export function tableOf(materials: Pick<Material, "texture">[], images: Image[]): Uint32Array<ArrayBuffer> {
  const firsts = [0];
  for (const image of images) firsts.push(firsts.at(-1)! + texelsOf(image));
  const table = new Uint32Array(TABLE_WORDS * materials.length);
  const floats = new Float32Array(table.buffer);
  materials.forEach(({ texture }, n) => {
    const image = texture && images[texture.image];
    if (!image) return;
    const wraps = codeOf(texture.wrapS) + 4 * codeOf(texture.wrapT);
    table.set([firsts[texture.image], image.columns, image.rows, wraps], TABLE_WORDS * n);
    floats.set(factorOf(texture), TABLE_WORDS * n + 4);
  });
  return table;
}

/** As the shaders know it. */
const codeOf = (wrap: Texture_Wrap) => (wrap === Texture_Wrap.WRAP_UNSPECIFIED ? Texture_Wrap.REPEAT : wrap);
