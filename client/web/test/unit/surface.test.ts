import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { ReadMeshResponseSchema } from "../../src/gen/alvor/v1/scene_service_pb";
import { BaseMesh } from "../../src/mirror/base_mesh";
import type { Leaves } from "../../src/mirror/leaves";
import { Mirror } from "../../src/mirror/mirror";
import { childIndex, levelOf, QUARTERS, slabsOfAncestor, slabsOfChildren } from "../../src/mirror/patch_id";
import { SLOT_INDICES, SLOT_VERTICES, Surface, type SurfaceChange } from "../../src/mirror/surface";

const across = (root: number, edge: number, smooth: boolean) => BigInt(1 + 8 * root + 2 * edge + Number(smooth));

/** Two unit squares and a triangle beside each other in a plane, and a wall that stands at the first. */
function mesh(): BaseMesh {
  const none = 0n;
  return new BaseMesh([
    create(ReadMeshResponseSchema, {
      cornerCounts: [4, 4, 3, 4],
      materials: [0, 0, 0, 1],
      sceneFaces: [0, 1, 2, 3],
      cornerCoordinates: [
        ...[0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0],
        ...[1, 0, 0, 2, 0, 0, 2, 1, 0, 1, 1, 0],
        ...[2, 0, 0, 3, 0, 0, 2, 1, 0],
        ...[0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1],
      ],
      neighbours: [
        ...[none, across(1, 3, true), none, across(3, 0, false)],
        ...[none, across(2, 2, true), none, across(0, 1, true)],
        ...[none, none, across(1, 1, true)],
        ...[across(0, 3, false), none, none, none],
      ],
    }),
  ]);
}

const path = (children: number[]) =>
  children.reduce((bits, child, n) => bits + child * 4 ** (15 - n - 1) * 2, 0) + 4 ** (15 - children.length);

function leaves(list: [root: number, children: number[], irradiance: number, slabs?: number][]): Leaves {
  return {
    count: list.length,
    face: Uint32Array.from(list.map((leaf) => leaf[0])),
    path: Uint32Array.from(list.map((leaf) => path(leaf[1]))),
    slabs: Uint16Array.from(list.map((leaf) => leaf[3] ?? 0)),
    rgb: Float32Array.from(list.flatMap((leaf) => [leaf[2], leaf[2], leaf[2]])),
  };
}

/** What a viewer would hold after these changes. */
class Drawn {
  positions: Float32Array = new Float32Array(0);
  values: Float32Array = new Float32Array(0);
  triangles: Uint32Array = new Uint32Array(0);
  slots = 0;

  take(change: SurfaceChange): number {
    this.slots = change.slotCount;
    this.positions = copy(this.positions, change.positions, 3 * SLOT_VERTICES, this.slots);
    this.values = copy(this.values, change.values, 4 * SLOT_VERTICES, this.slots);
    this.triangles = copy(this.triangles, change.triangles, SLOT_INDICES, this.slots);
    return change.values.data.length / (4 * SLOT_VERTICES);
  }

  /** Sides of drawn triangles that belong to one only. */
  freeSides(): string[] {
    const sides = new Map<string, number>();
    const key = (vertex: number) => [0, 1, 2].map((x) => this.positions[3 * vertex + x]).join();
    for (let n = 0; n < this.triangles.length; n += 3) {
      const names = [...this.triangles.subarray(n, n + 3)].map(key);
      if (new Set(names).size < 3) continue;
      for (let k = 0; k < 3; ++k) {
        const side = [names[k], names[(k + 1) % 3]].sort().join(" ");
        sides.set(side, (sides.get(side) ?? 0) + 1);
      }
    }
    return [...sides].filter(([, count]) => count === 1).map(([side]) => side);
  }

  /** The triangles that have an area: places and values of their corners. */
  seen(): string[] {
    const corner = (v: number) => [...this.positions.subarray(3 * v, 3 * v + 3), this.values[4 * v].toPrecision(5)].join();
    const all = Array.from({ length: this.triangles.length / 3 }, (_, n) => [...this.triangles.subarray(3 * n, 3 * n + 3)]);
    return all.filter(([a, b, c]) => new Set([a, b, c]).size === 3).map((three) => three.map(corner).join(" ")).sort();
  }

  /** Values of the drawn vertices at a place. */
  at(x: number, y: number, z: number, centre: number[]): Set<number> {
    const found = new Set<number>();
    for (const v of this.triangles)
      if (Math.hypot(...[x, y, z].map((c, k) => this.positions[3 * v + k] + centre[k] - c)) < 1e-6)
        found.add(this.values[4 * v]);
    return found;
  }
}

function copy<Data extends Float32Array | Uint32Array>(
  old: Data,
  change: { ranges: Uint32Array; data: Data },
  stride: number,
  slots: number,
): Data {
  const all = new (old.constructor as new (length: number) => Data)(slots * stride);
  all.set(old as never);
  let from = 0;
  for (let n = 0; n < change.ranges.length; n += 2) {
    const length = change.ranges[n + 1] * stride;
    all.set(change.data.subarray(from, from + length) as never, change.ranges[n] * stride);
    from += length;
  }
  return all;
}

function drawn(base: BaseMesh) {
  const surface = new Surface(base);
  const mirror = new Mirror(base.rootCount, surface);
  surface.attach(mirror);
  const picture = new Drawn();
  return { surface, mirror, picture };
}

/** How many sides the outline of the whole has: 3 of the first square, 2 of the second, 2 of the triangle, 3 of the wall. */
const OUTLINE = 2 + 2 + 2 + 3;

describe("the surface", () => {
  it("has no crack where leaves of different levels meet, at creases too", () => {
    const { surface, mirror, picture } = drawn(mesh());
    picture.take(surface.flush());
    expect(picture.freeSides()).toHaveLength(OUTLINE);
    mirror.apply(leaves([[0, [0], 1], [0, [1], 2], [0, [2], 3], [0, [3], 4], [1, [], 5], [2, [], 6], [3, [], 7]]));
    picture.take(surface.flush());
    // The first square's two outer sides are halves now; what is inside is joined.
    expect(picture.freeSides()).toHaveLength(OUTLINE + 2);
    mirror.apply(leaves([[1, [0], 5], [1, [1], 5], [1, [2], 5], [1, [3], 5], [2, [2], 6], [2, [3], 6]]));
    picture.take(surface.flush());
    expect(picture.freeSides()).toHaveLength(OUTLINE + 2 + 2 + 2);
  });

  it("goes on smoothly within a plane and not around a crease", () => {
    const base = mesh();
    const { surface, mirror, picture } = drawn(base);
    mirror.apply(leaves([[0, [], 1], [1, [], 3], [2, [], 3], [3, [], 9]]));
    picture.take(surface.flush());
    expect(picture.at(1, 0, 0, base.centre)).toEqual(new Set([2]));
    expect(picture.at(0, 0, 0, base.centre)).toEqual(new Set([1, 9]));
  });

  it("weights slabs by their areas", () => {
    const base = mesh();
    const { surface, mirror, picture } = drawn(base);
    const slabs = [0, 1, 2, 3].map((k): [number, number[], number, number] => [0, [k], 4, 1]);
    mirror.apply(leaves([...slabs, [1, [], 1], [2, [], 3], [3, [], 9]]));
    picture.take(surface.flush());
    expect([...picture.at(1, 0, 0, base.centre)]).toEqual([expect.closeTo((4 * 4 + 1) / 5, 5)]);
  });

  it("writes again only what changed", () => {
    const { surface, mirror, picture } = drawn(mesh());
    const deep = [0, 1, 2, 3].flatMap((a) => [0, 1, 2, 3].map((b) => [0, [a, b], 1] as [number, number[], number]));
    mirror.apply(leaves([...deep, [1, [], 1], [2, [], 1], [3, [], 1]]));
    picture.take(surface.flush());
    expect(surface.flush().values.data).toHaveLength(0);
    mirror.apply(leaves([[2, [], 2]]));
    expect(picture.take(surface.flush())).toBeLessThan(8);
  });

  it("gives places that are lit by nothing no part in their neighbours", () => {
    const base = mesh();
    const { surface, mirror, picture } = drawn(base);
    mirror.apply(leaves([[0, [], 0], [1, [], 3], [2, [], 3], [3, [], 9]]));
    picture.take(surface.flush());
    expect(picture.at(1, 0, 0, base.centre)).toEqual(new Set([3]));
  });

  it("is after splits and merges what it is when made of the leaves that are left", () => {
    let random = 7;
    const dice = (sides: number) => (random = (random * 48271) % 2147483647) % sides; // Lehmer's
    const { surface, mirror, picture } = drawn(mesh());
    mirror.apply(leaves([0, 1, 2, 3].map((root) => [root, [], 1 + root])));
    for (let round = 0; round < 200; ++round) {
      const there = [...mirror.leaves()];
      const { face, path: whole, slabs } = there[dice(there.length)];
      const level = levelOf(whole);
      const children = Array.from({ length: level }, (_, n) => childIndex(whole, n + 1));
      const deeper = [...children, dice(4)];
      const place = round % 6 === 0 ? children.slice(0, Math.max(0, level - 1 - dice(2))) : deeper.slice(0, 5);
      const how = face !== 2 && slabs >> 5 === 0 ? dice(3) : QUARTERS; // face 2 is a triangle
      const code = place.length <= level ? slabsOfAncestor(slabs, place.length) : slabsOfChildren(slabs, level, how);
      mirror.apply(leaves([[face, place, 1 + dice(100), code]]));
      if (round % 60 === 50) mirror.apply(leaves([[round % 2, [dice(4)], 1 + dice(100), dice(3)]])); // perhaps another split
      if (dice(3) === 0) picture.take(surface.flush());
    }
    picture.take(surface.flush());
    const fresh = drawn(mesh());
    const left = [...mirror.leaves()];
    fresh.mirror.apply({
      count: left.length,
      face: Uint32Array.from(left, ({ face }) => face),
      path: Uint32Array.from(left, ({ path }) => path),
      slabs: Uint16Array.from(left, ({ slabs }) => slabs),
      rgb: Float32Array.from(left.flatMap(({ rgb }) => rgb)),
    });
    fresh.picture.take(fresh.surface.flush());
    expect(left.length).toBeGreaterThan(20);
    expect(new Set(left.map(({ slabs }) => slabs)).size).toBeGreaterThan(5);
    expect(mirror.leafCount).toBe(left.length);
    expect(mirror.stateHash).toBe(fresh.mirror.stateHash);
    expect(picture.seen()).toEqual(fresh.picture.seen());
    const most = 4 * 200; // without merges; nodes that became unused are used again
    expect(mirror.nodeCount).toBeLessThan(most);
  });
});
