// Leaves that are slabs: how frames tell them, and where they lie.

import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { ReadMeshResponseSchema } from "../../src/gen/alvor/v1/scene_service_pb";
import { Detail, LeafErrorsSchema, LeafValuesSchema } from "../../src/gen/alvor/v1/solve_service_pb";
import { BaseMesh } from "../../src/mirror/base_mesh";
import { decodeErrors } from "../../src/mirror/errors";
import { BadFrame, decodeLeaves, type Leaves } from "../../src/mirror/leaves";
import { Mirror } from "../../src/mirror/mirror";
import { QUARTERS, SLABS_ALONG_U, SLABS_ALONG_V } from "../../src/mirror/patch_id";
import { probe } from "../../src/mirror/probe";
import { SLOT_VERTICES, Surface } from "../../src/mirror/surface";

/** From the root down: how each ancestor is split, and which of its children is meant. */
type Steps = [how: number, child: number][];
type Leaf = [steps: Steps, irradiance: number];

/** A leaf of root 0, by the words of docs/frame-format.md. */
function idOf(steps: Steps) {
  const path = steps.reduce((bits, [, child], n) => bits + child * 4 ** (14 - n) * 2, 0) + 4 ** (15 - steps.length);
  const fives = steps.flatMap(([how], level) => (how === QUARTERS ? [] : [1 + 2 * level + (how === SLABS_ALONG_V ? 1 : 0)]));
  return { path, slabs: (fives[0] ?? 0) + 32 * (fives[1] ?? 0) };
}

const leaves = (list: Leaf[]): Leaves => ({
  count: list.length,
  face: new Uint32Array(list.length),
  path: Uint32Array.from(list, ([steps]) => idOf(steps).path),
  slabs: Uint16Array.from(list, ([steps]) => idOf(steps).slabs),
  rgb: Float32Array.from(list.flatMap(([, light]) => [light, light, light])),
});

const four = (above: Steps, how: number, irradiances: number[]): Leaf[] => irradiances.map((light, k) => [[...above, [how, k]], light]);

/** Slabs along v in a quarter's slab along u, with all that is around them: slabs along u in slab 2 of slabs along v, and quarters in one of those. */
const MANY: Leaf[] = [
  ...four([[QUARTERS, 1]], SLABS_ALONG_U, [1, 2, 3, 4]).slice(0, 3),
  ...four([[QUARTERS, 1], [SLABS_ALONG_U, 3]], SLABS_ALONG_V, [5, 6, 7, 8]),
  ...four([[QUARTERS, 2]], SLABS_ALONG_V, [9, 10, 11, 12]).filter((_, k) => k !== 2),
  ...four([[QUARTERS, 2], [SLABS_ALONG_V, 2]], SLABS_ALONG_U, [13, 14, 15, 16]).filter((_, k) => k !== 1),
  ...four([[QUARTERS, 2], [SLABS_ALONG_V, 2], [SLABS_ALONG_U, 1]], QUARTERS, [17, 18, 19, 20]),
  ...four([], QUARTERS, [21, 0, 0, 24]).filter((_, k) => k % 3 === 0),
];

/** Returns the sides of the rectangle of a leaf, in parts of its root's. */
function placeOf(steps: Steps): { u: number; v: number; width: number; height: number } {
  let [u, v, width, height] = [0, 0, 1, 1];
  for (const [how, k] of steps) {
    const columns = how === QUARTERS ? 2 : how === SLABS_ALONG_U ? 4 : 1;
    [width, height] = [width / columns, height / (4 / columns)];
    [u, v] = [u + (k % columns) * width, v + Math.floor(k / columns) * height];
  }
  return { u, v, width, height };
}

/** A square with sides of 1. */
function square(): BaseMesh {
  const grey = { emission: { r: 0, g: 0, b: 0 }, reflectance: { r: 0.5, g: 0.5, b: 0.5 } };
  return new BaseMesh([
    create(ReadMeshResponseSchema, {
      cornerCounts: [4],
      materials: [0],
      sceneFaces: [0],
      cornerCoordinates: [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0],
      neighbours: [0n, 0n, 0n, 0n],
      sceneMaterials: [grey],
    }),
  ]);
}

function shown() {
  const mesh = square();
  const surface = new Surface(mesh);
  const mirror = new Mirror(1, surface);
  surface.attach(mirror);
  return { mesh, surface, mirror };
}

/** A zstd frame of one block that is not compressed. */
function zstdOf(bytes: number[]): Uint8Array {
  const block = 1 + 8 * bytes.length;
  return Uint8Array.of(0x28, 0xb5, 0x2f, 0xfd, 0x20, bytes.length, block & 255, block >> 8, 0, ...bytes);
}

/** Decodes leaves of which only the bytes of their ids are not 0. */
function decoded(...ids: number[][]) {
  const bytes = [...ids.flat(), ...Array<number>(4 * ids.length).fill(0)];
  const message = { detail: Detail.DISPLAY, count: ids.length, rawSize: bytes.length, zstd: zstdOf(bytes) };
  const { face, path, slabs } = decodeLeaves(create(LeafValuesSchema, message));
  return Array.from(face, (f, n) => ({ face: f, path: path[n], slabs: slabs[n] }));
}

const ESCAPE = 7;

describe("the id of a slab", () => {
  it("is told with its code, and those of its neighbours are guessed", () => {
    expect(decoded([ESCAPE, 0x81, 1, 0], [0], [0], [0], [0])).toEqual([
      ...[0, 1, 2, 3].map((k) => ({ face: 0, ...idOf([[SLABS_ALONG_U, k]]) })),
      { face: 1, ...idOf([[QUARTERS, 0]]) },
    ]);
  });

  it("is guessed from common ancestors only", () => {
    const sameLevel = 0;
    const levelAbove = 1;
    expect(decoded([ESCAPE, 0x82, 1 | (4 << 5), 0], [sameLevel], [sameLevel], [sameLevel], [levelAbove])).toEqual([
      ...[0, 1, 2, 3].map((k) => ({ face: 0, ...idOf([[SLABS_ALONG_U, 0], [SLABS_ALONG_V, k]]) })),
      { face: 0, ...idOf([[SLABS_ALONG_U, 1]]) },
    ]);
  });

  it("has the upper two bits of its code in a second byte", () => {
    const steps: Steps = [[SLABS_ALONG_U, 0], ...Array<Steps[0]>(6).fill([QUARTERS, 0]), [SLABS_ALONG_V, 0]];
    expect(decoded([ESCAPE, 0x88, 1, 2])).toEqual([{ face: 0, ...idOf(steps) }]);
  });

  it.each([
    ["with slabs below the leaf", 1, 3],
    ["with second slabs and no first", 1, 1 << 5],
    ["with second slabs above the first", 2, 3 | (1 << 5)],
    ["with the same slabs twice", 2, 1 | (1 << 5)],
    ["whose u is finer than the finest", 15, 1],
    ["whose v is finer than the finest", 14, 2 | (4 << 5)],
  ])("is refused %s", (_, level, code) => {
    expect(() => decoded([ESCAPE, 0x80 + level, code & 255, code >> 8])).toThrow(BadFrame);
  });

  it("is refused where a guessed code makes it finer than the finest", () => {
    const [sameLevel, levelBelow] = [0, 2];
    expect(decoded([ESCAPE, 0x8e, 1, 0], [sameLevel])).toHaveLength(2);
    expect(() => decoded([ESCAPE, 0x8e, 1, 0], [levelBelow])).toThrow(BadFrame);
  });

  it("is refused if it says that a common ancestor is split otherwise than the leaf before said", () => {
    const first = [ESCAPE, 0x81, 1, 0];
    expect(() => decoded(first, [ESCAPE, 0x81, 0, 0])).toThrow(BadFrame);
    expect(() => decoded(first, [ESCAPE, 0x81, 2, 0])).toThrow(BadFrame);
    expect(() => decoded(first, [ESCAPE, 0x82, 3, 0])).toThrow(BadFrame);
    expect(() => decoded([0], [ESCAPE, 0x81, 1, 0])).not.toThrow(); // of another root
    expect(decoded(first, [ESCAPE, 0x82, 1 | (4 << 5), 0])[1]).toEqual({ face: 0, ...idOf([[SLABS_ALONG_U, 1], [SLABS_ALONG_V, 0]]) });
  });

  it("is refused where its code is too large or cut off", () => {
    expect(() => decoded([ESCAPE, 0x81, 1, 4])).toThrow(BadFrame);
    expect(() => decoded([ESCAPE, 0x81, 1])).toThrow(BadFrame);
  });
});

describe("the id of a leaf", () => {
  it("is refused if its face is not below 2^22", () => {
    expect(decoded([0xf8, 0xff, 0xff, 0x0f])[0].face).toBe(2 ** 22 - 1);
    expect(() => decoded([0x80, 0x80, 0x80, 0x10])).toThrow(BadFrame);
  });
});

describe("a mirror with slabs", () => {
  it("holds the leaves that it was told", () => {
    const mirror = new Mirror(1);
    mirror.apply(leaves(MANY));
    const told = MANY.map(([steps, light]) => ({ face: 0, ...idOf(steps), rgb: [light, light, light] }));
    expect([...mirror.leaves()]).toEqual(told.sort((a, b) => a.path - b.path));
    expect(mirror.leafCount).toBe(MANY.length);
    const mean = MANY.reduce((sum, [steps, light]) => sum + light / 4 ** steps.length, 0);
    mirror.meanIrradiance(0).forEach((x) => expect(x).toBeCloseTo(mean, 10));
  });

  it("takes slabs that are told after their siblings, which inherit", () => {
    const mirror = new Mirror(1);
    mirror.apply(leaves([[[], 5]]));
    mirror.apply(leaves([[[[SLABS_ALONG_U, 2], [SLABS_ALONG_V, 1]], 7]]));
    const around = [...four([], SLABS_ALONG_U, [5, 5, 5, 5]), ...four([[SLABS_ALONG_U, 2]], SLABS_ALONG_V, [5, 7, 5, 5])];
    const expected = new Mirror(1);
    expected.apply(leaves(around.filter((_, n) => n !== 2)));
    expect([...mirror.leaves()]).toEqual([...expected.leaves()]);
  });

  it("merges a node that is told with another split, and splits it anew", () => {
    const before = four([[QUARTERS, 3]], SLABS_ALONG_U, [1, 2, 3, 4]);
    const { surface, mirror } = shown();
    mirror.apply(leaves([[[], 9], ...before, ...four([[QUARTERS, 3], [SLABS_ALONG_U, 0]], QUARTERS, [5, 6, 7, 8])]));
    surface.flush();
    mirror.apply(leaves([[[[QUARTERS, 3], [SLABS_ALONG_V, 2]], 10]]));
    const fresh = shown();
    const after = four([[QUARTERS, 3]], SLABS_ALONG_V, [5, 5, 10, 5]); // those not told inherit from the first that there was
    fresh.mirror.apply(leaves([...four([], QUARTERS, [9, 9, 9, 0]).slice(0, 3), ...after]));
    expect([...mirror.leaves()]).toEqual([...fresh.mirror.leaves()]);
    expect(mirror.leafCount).toBe(7);
    expect(mirror.stateHash).toBe(fresh.mirror.stateHash);
  });

  it("has the hash of its leaves, with the slab code in the upper word of the id", () => {
    const mirror = new Mirror(1);
    const list = four([], SLABS_ALONG_V, [1, 2, 3, 4]);
    mirror.apply(leaves(list));
    mirror.apply(leaves(four([[SLABS_ALONG_V, 1]], SLABS_ALONG_U, [5, 6, 7, 8])));
    const all = [...list.filter((_, k) => k !== 1), ...four([[SLABS_ALONG_V, 1]], SLABS_ALONG_U, [5, 6, 7, 8])];
    expect(mirror.stateHash).toBe(hashOf(all));
  });

  it("takes errors from a slab on", () => {
    const mirror = new Mirror(1);
    mirror.apply(leaves(four([], SLABS_ALONG_U, [1, 2, 3, 4])));
    const { path, slabs } = idOf([[SLABS_ALONG_U, 2]]);
    const page = (code: number) =>
      decodeErrors(create(LeafErrorsSchema, { firstPatch: (BigInt(code) << 54n) | BigInt(path), scale: 0, count: 2, zstd: zstdOf([8, 16]) }));
    mirror.takeErrors(page(slabs));
    expect([...mirror.leavesUnder(0)].map((leaf) => mirror.errors[leaf])).toEqual([0, 0, 2, 4]);
    expect(() => mirror.takeErrors(page(2))).toThrow(BadFrame);
  });
});

describe("a slab", () => {
  it("is drawn where it lies, lapping over its neighbours by a thousandth of its length", () => {
    const { mesh, surface, mirror } = shown();
    mirror.apply(leaves(MANY));
    const { positions, values } = surface.flush();
    for (const [steps, light] of MANY) {
      const { u, v, width, height } = placeOf(steps);
      const slot = Array.from({ length: MANY.length }, (_, n) => n).find((n) => values.data[4 * SLOT_VERTICES * n] === light)!;
      const vertex = (k: number) => [0, 1].map((x) => positions.data[3 * (SLOT_VERTICES * slot + k) + x] + mesh.centre[x]);
      expect(vertex(0)).toEqual([u + width / 2, v + height / 2]);
      const lap = steps.some(([how]) => how !== QUARTERS) ? Math.max(width, height) / 1024 : 0;
      const [low, high, left, right] = [v - lap, v + height + lap, u - lap, u + width + lap];
      const corners = [[left, low], [right, low], [right, high], [left, high], [u + width / 2, low], [right, v + height / 2]];
      corners.flat().forEach((x, n) => expect([1, 2, 3, 4, 5, 6].map(vertex).flat()[n]).toBeCloseTo(x, 6));
    }
  });

  it("covers its root with its neighbours, and little more", () => {
    const { surface, mirror } = shown();
    mirror.apply(leaves(MANY));
    const { positions, triangles } = surface.flush();
    const at = (n: number, x: number) => positions.data[3 * triangles.data[n] + x];
    let area = 0;
    for (let n = 0; n < triangles.data.length; n += 3) {
      const [ab, ac] = [1, 2].map((k) => [0, 1].map((x) => at(n + k, x) - at(n, x)));
      expect(ab[0] * ac[1] - ab[1] * ac[0]).toBeGreaterThanOrEqual(0);
      area += (ab[0] * ac[1] - ab[1] * ac[0]) / 2;
    }
    expect(area).toBeGreaterThan(1);
    expect(area).toBeLessThan(1.01);
  });

  it("is found by a point in it", () => {
    const { mesh, mirror } = shown();
    mirror.apply(leaves(MANY));
    for (const [steps, light] of MANY) {
      const { u, v, width, height } = placeOf(steps);
      for (const [x, y] of [[0.1, 0.1], [0.9, 0.1], [0.1, 0.9], [0.9, 0.9]]) {
        const origin = { x: u + x * width - mesh.centre[0], y: v + y * height - mesh.centre[1], z: 1 };
        const reading = probe(mesh, mirror, origin, { x: 0, y: 0, z: -1 })!;
        expect(reading.irradiance).toEqual([light, light, light]);
        expect(reading.level).toBe(steps.length);
      }
    }
  });

  it.each([
    ["as thin as the grid", [[SLABS_ALONG_U, 3], ...Array<Steps[0]>(13).fill([QUARTERS, 3])] as Steps],
    ["wide and flat", [...Array<Steps[0]>(13).fill([QUARTERS, 3]), [SLABS_ALONG_V, 3]] as Steps],
  ])("has middles on its longer edges only, %s", (_, steps) => {
    const { surface, mirror } = shown();
    mirror.apply(leaves([[steps, 3]]));
    const links = surface as unknown as { slotOfNode: Int32Array; smooth: { pointOf: Int32Array } };
    const leaf = [...mirror.leavesUnder(0)].find((node) => mirror.rgb[3 * node] === 3)!;
    const points = links.smooth.pointOf.subarray(8 * links.slotOfNode[leaf], 8 * links.slotOfNode[leaf] + 8);
    const { width, height } = placeOf(steps);
    expect([...points].map((point) => point >= 0)).toEqual([true, true, true, true, width > height, width < height, width > height, width < height]);
  });
});

/** The hash of docs/frame-format.md of leaves of root 0, in whole numbers of any size. */
function hashOf(list: Leaf[]): bigint {
  const word = (x: bigint) => x & 0xffffffffn;
  const finished = (x: bigint) => {
    x = word((x ^ (x >> 16n)) * 0x85ebca6bn);
    x = word((x ^ (x >> 13n)) * 0xc2b2ae35n);
    return x ^ (x >> 16n);
  };
  let [upper, lower] = [0n, 0n];
  for (const [steps, light] of list) {
    const { path, slabs } = idOf(steps);
    const bits = BigInt(new Uint32Array(Float32Array.of(light).buffer)[0]);
    let [a, b] = [0x9e3779b9n, 0x85ebca6bn];
    for (const x of [BigInt(slabs) << 22n, BigInt(path), bits, bits, bits]) {
      a = word((a ^ x) * 0x9e3779b1n);
      a ^= a >> 15n;
      b = word((b ^ x) * 0x85ebca77n);
      b ^= b >> 13n;
    }
    [upper, lower] = [word(upper + finished(a)), word(lower + finished(b))];
  }
  return (upper << 32n) | lower;
}
