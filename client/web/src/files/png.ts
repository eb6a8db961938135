// Sums the colours of a PNG (ISO/IEC 15948). Browsers decode PNG too, but multiply colours by alpha and cut 16 bits to 8.

import { linearTable } from "./srgb";
import type { Bands, PixelSum } from "./texture_colour";

const SIGNATURE = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];
const PALETTE = 3;
const CHANNELS: Record<number, number> = { 0: 1, 2: 3, 3: 1, 4: 2, 6: 4 };
// First column, first row, step of columns and rows of each pass of an interlaced picture.
const PASSES = [[0, 0, 8, 8], [4, 0, 8, 8], [0, 4, 4, 8], [2, 0, 4, 4], [0, 2, 2, 4], [1, 0, 2, 2], [0, 1, 1, 2]];

export const isPng = (bytes: Uint8Array) => SIGNATURE.every((byte, n) => bytes[n] === byte);

interface Header {
  width: number;
  height: number;
  depth: number;
  kind: number;
  isInterlaced: boolean;
}

/** Throws an Error for what is no PNG or has more than `mostPixels`. */
export async function sumOfPng(file: Uint8Array<ArrayBuffer>, mostPixels: number): Promise<PixelSum> {
  const chunks = chunksOf(file);
  const header = headerOf(chunks.find(({ type }) => type === "IHDR")!.data);
  if (header.width * header.height === 0 || header.width * header.height > mostPixels) throw new Error("too many pixels or none");
  const palette = chunks.find(({ type }) => type === "PLTE")?.data ?? new Uint8Array();
  const rows = new Rows(header, new ColourSum(header, palette));
  const packed = new Blob(chunks.filter(({ type }) => type === "IDAT").map(({ data }) => data));
  const reader = packed.stream().pipeThrough(new DecompressionStream("deflate")).getReader();
  for (let part = await reader.read(); !part.done && !rows.isDone; part = await reader.read()) rows.take(part.value);
  if (!rows.isDone) throw new Error("too few rows");
  void reader.cancel().catch(() => undefined);
  return { sum: rows.colours.sum, count: header.width * header.height };
}

function chunksOf(file: Uint8Array<ArrayBuffer>): { type: string; data: Uint8Array<ArrayBuffer> }[] {
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  const chunks = [];
  for (let at = SIGNATURE.length; at + 8 <= file.length; ) {
    const size = view.getUint32(at);
    const type = String.fromCharCode(...file.subarray(at + 4, at + 8));
    chunks.push({ type, data: file.subarray(at + 8, at + 8 + size) });
    at += 12 + size;
  }
  return chunks;
}

function headerOf(data: Uint8Array): Header {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const kind = data[9];
  if (!(kind in CHANNELS) || ![1, 2, 4, 8, 16].includes(data[8])) throw new Error("unknown kind of pixels");
  return { width: view.getUint32(0), height: view.getUint32(4), depth: data[8], kind, isInterlaced: data[12] === 1 };
}

/** Puts rows together from the bytes of all passes, and undoes their filters. */
class Rows {
  private readonly passes: { bytes: number; pixels: number; rows: number }[];
  private readonly step: number;
  private row!: Uint8Array;
  private above!: Uint8Array;
  private filled = 0;
  private rowsLeft = 0;

  constructor(
    { width, height, depth, kind, isInterlaced }: Header,
    readonly colours: ColourSum,
  ) {
    const bits = depth * CHANNELS[kind];
    this.step = Math.max(1, bits / 8);
    this.passes = (isInterlaced ? PASSES : [[0, 0, 1, 1]])
      .map(([x, y, dx, dy]) => ({ pixels: Math.ceil((width - x) / dx), rows: Math.ceil((height - y) / dy) }))
      .filter(({ pixels, rows }) => pixels > 0 && rows > 0)
      .map(({ pixels, rows }) => ({ pixels, rows, bytes: 1 + Math.ceil((pixels * bits) / 8) }));
    this.beginPass();
  }

  get isDone(): boolean {
    return this.passes.length === 0;
  }

  take(bytes: Uint8Array): void {
    for (let at = 0; at < bytes.length && !this.isDone; ) {
      const count = Math.min(bytes.length - at, this.row.length - this.filled);
      this.row.set(bytes.subarray(at, at + count), this.filled);
      at += count;
      this.filled += count;
      if (this.filled === this.row.length) this.endRow();
    }
  }

  private beginPass(): void {
    const [pass] = this.passes;
    if (!pass) return;
    this.rowsLeft = pass.rows;
    this.row = new Uint8Array(pass.bytes);
    this.above = new Uint8Array(pass.bytes);
  }

  private endRow(): void {
    unfilter(this.row, this.above, this.step);
    this.colours.add(this.row.subarray(1), this.passes[0].pixels);
    [this.row, this.above] = [this.above, this.row];
    this.filled = 0;
    if (--this.rowsLeft > 0) return;
    this.passes.shift();
    this.beginPass();
  }
}

/** The first byte of each row is its filter's number. `step` is the number of bytes from a pixel to the next. */
function unfilter(row: Uint8Array, above: Uint8Array, step: number): void {
  const filter = row[0];
  if (filter > 4) throw new Error("unknown filter");
  for (let n = 1; n < row.length; ++n) {
    const left = n > step ? row[n - step] : 0;
    const corner = n > step ? above[n - step] : 0;
    if (filter === 1) row[n] += left;
    else if (filter === 2) row[n] += above[n];
    else if (filter === 3) row[n] += (left + above[n]) >> 1;
    else if (filter === 4) row[n] += paeth(left, above[n], corner);
  }
}

function paeth(left: number, above: number, corner: number): number {
  const [a, b, c] = [Math.abs(above - corner), Math.abs(left - corner), Math.abs(left + above - 2 * corner)];
  return a <= b && a <= c ? left : b <= c ? above : corner;
}

/** Sums pixels in linear light; alpha takes no part. */
class ColourSum {
  readonly sum: Bands = [0, 0, 0];
  private readonly linear: Float64Array;

  constructor(
    private readonly header: Header,
    private readonly palette: Uint8Array,
  ) {
    this.linear = linearTable(header.kind === PALETTE ? 255 : 2 ** header.depth - 1);
  }

  add(row: Uint8Array, pixels: number): void {
    const { kind } = this.header;
    const channels = CHANNELS[kind];
    const isGrey = channels <= 2 && kind !== PALETTE;
    for (let pixel = 0; pixel < pixels; ++pixel)
      for (let band = 0; band < 3; ++band) {
        const sample = this.sampleAt(row, pixel * channels + (isGrey || kind === PALETTE ? 0 : band));
        this.sum[band] += this.linear[kind === PALETTE ? (this.palette[3 * sample + band] ?? 0) : sample];
      }
  }

  private sampleAt(row: Uint8Array, n: number): number {
    const { depth } = this.header;
    if (depth === 8) return row[n];
    if (depth === 16) return 256 * row[2 * n] + row[2 * n + 1];
    const bit = n * depth;
    return (row[bit >> 3] >> (8 - depth - (bit & 7))) & (2 ** depth - 1);
  }
}
