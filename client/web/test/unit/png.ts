// Writes small PNGs of any kind.

import { deflateSync } from "node:zlib";

function chunk(type: string, data: Uint8Array): Buffer {
  const size = Buffer.alloc(4);
  size.writeUInt32BE(data.length);
  return Buffer.concat([size, Buffer.from(type), data, Buffer.alloc(4)]); // readers here check no sums
}

export interface Picture {
  width: number;
  height: number;
  depth: number;
  kind: number;
  interlaced?: boolean;
  palette?: number[];
  /** As in the file: each row begins with its filter. */
  rows: number[];
}

export function pngOf({ width, height, depth, kind, interlaced = false, palette, rows }: Picture): Uint8Array<ArrayBuffer> {
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([depth, kind, 0, 0, Number(interlaced)], 8);
  return new Uint8Array(
    Buffer.concat([
      Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]),
      chunk("IHDR", header),
      ...(palette ? [chunk("PLTE", Uint8Array.from(palette))] : []),
      chunk("IDAT", deflateSync(Uint8Array.from(rows))),
      chunk("IEND", new Uint8Array()),
    ]),
  );
}
