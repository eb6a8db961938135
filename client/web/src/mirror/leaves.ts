// What a frame says about leaves, decoded: docs/frame-format.md.

import { decompress } from "fzstd";
import { Detail, type LeafValues } from "../gen/alvor/v1/solve_service_pb";
import { areValidSlabs, commonLevel, FACE_BITS, MAX_LEVEL, slabsOfAncestor } from "./patch_id";

const MOST_LEAVES = 52_428;
const MOST_BYTES = 262_144;

/** Leaves in the order of their faces and paths, disjoint. An id is `slabs * 2^54 + face * 2^32 + path`. */
export interface Leaves {
  count: number;
  face: Uint32Array;
  path: Uint32Array;
  /** Slab codes. */
  slabs: Uint16Array;
  /** Irradiance, W/m2: r, g, b of each. */
  rgb: Float32Array;
}

export class BadFrame extends Error {}

export function decodeLeaves(values: LeafValues): Leaves {
  const { count, rawSize } = values;
  if (count > MOST_LEAVES || rawSize > MOST_BYTES) throw new BadFrame("a frame claims to be larger than frames are");
  const leaves: Leaves = {
    count,
    face: new Uint32Array(count),
    path: new Uint32Array(count),
    slabs: new Uint16Array(count),
    rgb: new Float32Array(3 * count),
  };
  if (count === 0) return leaves;
  const raw = unpack(values.zstd, rawSize);
  const valueBytes = values.detail === Detail.DISPLAY ? 4 * count : 12 * count;
  const idBytes = raw.length - valueBytes;
  if (idBytes < count) throw new BadFrame("a frame is too short for its leaves");
  decodeIds(raw.subarray(0, idBytes), leaves);
  if (values.detail === Detail.DISPLAY) decodeShared(raw.subarray(idBytes), values.scale, leaves);
  else decodeExact(raw.subarray(idBytes), leaves);
  return leaves;
}

export function unpack(zstd: Uint8Array, size: number): Uint8Array {
  let raw: Uint8Array;
  try {
    raw = decompress(zstd, new Uint8Array(size));
  } catch {
    throw new BadFrame("a frame is not compressed as it should be");
  }
  if (raw.length !== size) throw new BadFrame("a frame is not as long as it says");
  return raw;
}

const LEVEL_CHANGES = [0, -1, 1, -2, 2, -3, 3];
const ESCAPE = 7; // code of a level that follows as a byte
const TELLS_SLABS = 0x80; // added to such a byte: two bytes with the slab code follow
const FINEST_OF_FACE = 4 ** MAX_LEVEL;

// Finest patches of all faces are counted through, in a face and a rest of 30 bits, for a double holds 53 bits and a bad gap can be longer.
function decodeIds(bytes: Uint8Array, leaves: Leaves): void {
  let at = 0;
  let level = 0;
  let endFace = 0;
  let endRest = 0;
  const next = () => {
    if (at >= bytes.length) throw new BadFrame("a frame ends within its ids");
    return bytes[at++];
  };
  for (let n = 0; n < leaves.count; ++n) {
    let byte = next();
    const code = byte & 7;
    let gap = (byte & 0x7f) >> 3;
    for (let scale = 16; byte & 0x80; scale *= 128) {
      if (scale > 2 ** 46) throw new BadFrame("a gap between ids is too large");
      byte = next();
      gap += (byte & 0x7f) * scale;
    }
    level = code === ESCAPE ? next() : level + LEVEL_CHANGES[code];
    let slabs = -1;
    if (level & TELLS_SLABS && code === ESCAPE) {
      level -= TELLS_SLABS;
      slabs = next() | (next() << 8);
    }
    if (level < 0 || level > MAX_LEVEL) throw new BadFrame("a level is not one");
    const size = 4 ** (MAX_LEVEL - level);
    const perFace = FINEST_OF_FACE / size;
    const beginRest = Math.ceil(endRest / size) + (gap % perFace);
    const face = endFace + Math.floor(gap / perFace) + Math.floor(beginRest / perFace);
    const rest = (beginRest % perFace) * size;
    if (face >= 2 ** FACE_BITS) throw new BadFrame("an id is beyond all faces");
    leaves.face[n] = face;
    // The path's bits, then a single 1, then zeros: the middle of the patch in halves of a finest one.
    leaves.path[n] = rest * 2 + size;
    leaves.slabs[n] = checkedSlabs(leaves, n, level, slabs);
    endFace = face;
    endRest = rest + size;
  }
  if (at !== bytes.length) throw new BadFrame("a frame has bytes after its ids");
}

/**
 * Returns the slab code of a leaf: the told one, or if it is -1, the one of ancestors that are split as they were for the leaf before, and
 * into quarters where that has none of them. Throws BadFrame if no patch of this level has it, or the leaf before contradicts it.
 */
function checkedSlabs({ face, path, slabs }: Leaves, n: number, level: number, told: number): number {
  let common = 0; // level of the finest ancestor whose code the leaf before tells
  if (n > 0 && face[n] === face[n - 1]) common = commonLevel(path[n - 1], path[n]) + 1;
  const ofCommon = common > 0 ? slabsOfAncestor(slabs[n - 1], common) : 0;
  const code = told < 0 ? ofCommon : told;
  if (code > 1023 || !areValidSlabs(code, level)) throw new BadFrame("a slab code is not one");
  if (slabsOfAncestor(code, common) !== ofCommon) throw new BadFrame("a patch is split in two ways");
  return code;
}

function decodeShared(bytes: Uint8Array, scale: number, leaves: Leaves): void {
  const { count, rgb } = leaves;
  let r = 0;
  let g = 0;
  let b = 0;
  let before = 0;
  for (let n = 0; n < count; ++n) {
    const top = bytes[3 * count + n];
    const exponent = top >> 3;
    const guess = (m: number) => (before >= exponent ? Math.min(511, m * 2 ** (before - exponent)) : m >> (exponent - before));
    // Red and blue are told by how much more they change than green.
    const change = unfold(bytes[count + n] | ((top & 2) << 7));
    r = (guess(r) + change + unfold(bytes[n] | ((top & 4) << 6))) & 511;
    b = (guess(b) + change + unfold(bytes[2 * count + n] | ((top & 1) << 8))) & 511;
    g = (guess(g) + change) & 511;
    const unit = 2 ** (exponent + scale);
    rgb[3 * n] = r * unit;
    rgb[3 * n + 1] = g * unit;
    rgb[3 * n + 2] = b * unit;
    before = exponent;
  }
}

/** From how a difference modulo 512 was sent. */
function unfold(folded: number): number {
  return folded & 1 ? 511 - (folded >> 1) : folded >> 1;
}

function decodeExact(bytes: Uint8Array, leaves: Leaves): void {
  const { count } = leaves;
  const bits = new Uint32Array(leaves.rgb.buffer);
  for (let band = 0; band < 3; ++band) {
    let value = 0;
    for (let n = 0; n < count; ++n) {
      const at = 4 * band * count + n;
      value =
        (value + (bytes[at] | (bytes[at + count] << 8) | (bytes[at + 2 * count] << 16) | (bytes[at + 3 * count] << 24))) | 0;
      bits[3 * n + band] = value;
    }
  }
}
