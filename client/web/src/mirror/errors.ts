// Decodes the errors of leaves in a frame: docs/frame-format.md.

import type { LeafErrors } from "../gen/alvor/v1/solve_service_pb";
import { BadFrame, unpack } from "./leaves";
import { FACE_BITS } from "./patch_id";

const MOST_ERRORS = 262_144;
const FARTHEST_SCALE = 200;

/** Errors of consecutive leaves, in the order of their faces and paths, from this leaf on: one standard deviation each, W/m2. */
export interface ErrorPage {
  face: number;
  path: number;
  slabs: number;
  errors: Float32Array;
}

export function decodeErrors({ firstPatch, scale, count, zstd }: LeafErrors): ErrorPage {
  if (count === 0 || count > MOST_ERRORS) throw new BadFrame("a frame tells more errors than frames do");
  if (Math.abs(scale) > FARTHEST_SCALE) throw new BadFrame("a scale of errors is not one");
  const codes = unpack(zstd, count);
  const errorOf = Float32Array.from({ length: 256 }, (_, code) => (code === 0 ? 0 : 2 ** (scale + code / 8)));
  return {
    face: Number(firstPatch >> 32n) % 2 ** FACE_BITS,
    path: Number(firstPatch & 0xffffffffn),
    slabs: Number(firstPatch >> 32n) >>> FACE_BITS,
    errors: Float32Array.from(codes, (code) => errorOf[code]),
  };
}
