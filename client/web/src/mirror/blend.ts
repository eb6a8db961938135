// Weights of a root patch's corners at a point of it: values that are given at corners are mixed by them.

/** A point is corner 0, corner `second` and the corner after it, mixed; corner 0 has the share that is left. */
export interface Blend {
  second: 1 | 2;
  ofSecond: number;
  ofThird: number;
}

/**
 * Returns the shares of the corners of a quad's triangle 0, 1, 2 or 0, 2, 3 in a point, on whichever side of the diagonal the point lies.
 * Requires: `corners` are x, y, z of the four corners of a planar, convex quad, and `point` lies on it.
 */
export function blendOnQuad(corners: Float64Array, point: Float64Array): Blend {
  const from0 = (of: Float64Array, n: number): Arrow => [of[n] - corners[0], of[n + 1] - corners[1], of[n + 2] - corners[2]];
  const [b, c, d, p] = [from0(corners, 3), from0(corners, 6), from0(corners, 9), from0(point, 0)];
  const normal = cross(c, [d[0] - b[0], d[1] - b[1], d[2] - b[2]]);
  const area = (u: Arrow, v: Arrow) => dot(cross(u, v), normal);
  const beside = area(p, c); // positive on the side of corner 1
  const [first, second] = [area(b, c), area(c, d)];
  // A side without an area, where three corners lie in a line, holds no points of its own.
  if ((beside >= 0 && first > 0) || second <= 0) return { second: 1, ofSecond: beside / first, ofThird: area(b, p) / first };
  return { second: 2, ofSecond: area(p, d) / second, ofThird: -beside / second };
}

type Arrow = [number, number, number];

const dot = (a: Arrow, b: Arrow) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: Arrow, b: Arrow): Arrow => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
