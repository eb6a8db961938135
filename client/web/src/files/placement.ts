// Affine maps: where the axes and the origin go, as client/placement.h.

import { ImportError } from "./import_error";

type Vec3 = [number, number, number];

export interface Placement {
  x: Vec3;
  y: Vec3;
  z: Vec3;
  origin: Vec3;
}

export const IDENTITY: Placement = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1], origin: [0, 0, 0] };

export interface Transform {
  matrix?: number[];
  translation?: number[];
  rotation?: number[];
  scale?: number[];
}

const direction = ({ x, y, z }: Placement, d: Vec3) => [0, 1, 2].map((k) => d[0] * x[k] + d[1] * y[k] + d[2] * z[k]) as Vec3;

export const point = (placement: Placement, p: Vec3) => direction(placement, p).map((d, k) => d + placement.origin[k]) as Vec3;

/** First `inner`, then `outer`. */
export const product = (outer: Placement, inner: Placement): Placement => ({
  x: direction(outer, inner.x),
  y: direction(outer, inner.y),
  z: direction(outer, inner.z),
  origin: point(outer, inner.origin),
});

/** Says whether counter-clockwise becomes clockwise. */
export function mirrors({ x, y, z }: Placement): boolean {
  const [a, b, c] = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
  return a * z[0] + b * z[1] + c * z[2] < 0;
}

/** Of a node of glTF; `place` names it. Throws ImportError. */
export function placementOf({ matrix, translation, rotation, scale }: Transform, place: string): Placement {
  for (const [list, length] of [[matrix, 16], [translation, 3], [rotation, 4], [scale, 3]] as const)
    if (list && list.length > 0 && list.length !== length) throw new ImportError(place, "its transform has the wrong number of numbers");
  const column = (m: number[], n: number) => m.slice(4 * n, 4 * n + 3) as Vec3;
  if (matrix?.length) return { x: column(matrix, 0), y: column(matrix, 1), z: column(matrix, 2), origin: column(matrix, 3) };
  const turned = rotation?.length ? rotationOf(rotation, place) : IDENTITY;
  const [a, b, c] = scale?.length ? scale : [1, 1, 1];
  const by = (axis: Vec3, factor: number) => axis.map((k) => k * factor) as Vec3;
  return { x: by(turned.x, a), y: by(turned.y, b), z: by(turned.z, c), origin: translation?.length ? (translation as Vec3) : [0, 0, 0] };
}

/** From a unit quaternion x, y, z, w; one of another length is taken for its direction. */
function rotationOf([x, y, z, w]: number[], place: string): Placement {
  const norm = x * x + y * y + z * z + w * w;
  if (!(norm > 0)) throw new ImportError(place, "its rotation is no rotation");
  const s = 2 / norm;
  return {
    x: [1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)],
    y: [s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)],
    z: [s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)],
    origin: [0, 0, 0],
  };
}
