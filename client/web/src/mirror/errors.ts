// Decodes the errors of leaves in a frame: docs/frame-format.md.

import type { LeafErrors } from "../gen/alvor/v1/solve_service_pb";
import { BadFrame, unpack } from "./leaves";

const MOST_ERRORS = 262_144;
const FARTHEST_SCALE = 200;

/** Of consecutive leaves, in the order of their ids, from the leaf `face * 2^32 + path` on: one standard deviation each, W/m2. */
export interface ErrorPage {
  face: number;
  path: number;
  errors: Float32Array;
}

export function decodeErrors({ firstPatch, scale, count, zstd }: LeafErrors): ErrorPage {
  if (count === 0 || count > MOST_ERRORS) throw new BadFrame("a frame tells more errors than frames do");
  if (Math.abs(scale) > FARTHEST_SCALE) throw new BadFrame("a scale of errors is not one");
  const codes = unpack(zstd, count);
  const errorOf = Float32Array.from({ length: 256 }, (_, code) => (code === 0 ? 0 : 2 ** (scale + code / 8)));
  return {
    face: Number(firstPatch >> 32n),
    path: Number(firstPatch & 0xffffffffn),
    errors: Float32Array.from(codes, (code) => errorOf[code]),
  };
}
