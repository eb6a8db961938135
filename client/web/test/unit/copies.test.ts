import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { ReadMeshResponseSchema } from "../../src/gen/alvor/v1/scene_service_pb";
import { LookOfObjectSchema } from "../../src/gen/alvor/v1/solve_service_pb";
import { BaseMesh } from "../../src/mirror/base_mesh";
import { withCopies } from "../../src/mirror/copies";
import { Mirror } from "../../src/mirror/mirror";

const across = (root: number, edge: number) => BigInt(1 + 8 * root + 2 * edge + 1);

/** A wall, and a thing of two squares that meet, of which the second hangs from the first; in two messages. */
const messages = [
  create(ReadMeshResponseSchema, {
    cornerCounts: [4, 4],
    materials: [0, 1],
    sceneFaces: [0, 1],
    secondSceneFaces: [0, 0],
    cornerCoordinates: [...[0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], ...[1, 0, 0, 2, 0, 0, 2, 1, 0, 1, 1, 0]],
    neighbours: [0n, across(1, 3), 0n, 0n, 0n, across(2, 3), 0n, across(0, 1)],
  }),
  create(ReadMeshResponseSchema, {
    cornerCounts: [4],
    materials: [2],
    sceneFaces: [2],
    secondSceneFaces: [4],
    cornerCoordinates: [2, 0, 0, 3, 0, 0, 3, 1, 0, 2, 1, 0],
    neighbours: [0n, 0n, 0n, across(1, 1)],
    sceneObjects: [
      { name: "thing", firstFace: 1, faceCount: 1 },
      { name: "part", parent: 0, firstFace: 2, faceCount: 2 },
    ],
  }),
];
const copy = (number: number, copyOf: number, firstFace: number, faceCount: number) =>
  create(LookOfObjectSchema, { number, copyOf, name: `copy ${number}`, firstFace, faceCount });

describe("added objects", () => {
  it("have copies of the root patches of another, and of those that hang from it", () => {
    const copied = withCopies(messages, [copy(2, 0, 4, 3), copy(3, 1, 7, 2)]);
    expect(copied).toHaveLength(4);
    const [, , whole, part] = copied;
    expect(whole.cornerCounts).toEqual([4, 4]);
    expect(whole.materials).toEqual([1, 2]);
    expect(whole.sceneFaces).toEqual([4, 5]);
    expect(whole.secondSceneFaces).toEqual([0, 7]);
    expect(whole.cornerCoordinates.slice(12)).toEqual(messages[1].cornerCoordinates);
    expect(whole.neighbours).toEqual([0n, across(4, 3), 0n, 0n, 0n, 0n, 0n, across(3, 1)]); // not those of the wall
    expect(part.sceneFaces).toEqual([7]);
    expect(part.neighbours).toEqual([0n, 0n, 0n, 0n]);
    expect(withCopies(messages, [create(LookOfObjectSchema, { number: 0, hidden: true })])).toBe(messages);
  });
  it("make a mesh whose other root patches and middle are as before", () => {
    const before = new BaseMesh(messages);
    const after = new BaseMesh(withCopies(messages, [copy(2, 0, 4, 3)]));
    expect(after.rootCount).toBe(5);
    expect(after.centre).toEqual(before.centre);
    expect([...after.corners.subarray(0, before.corners.length)]).toEqual([...before.corners]);
    expect(after.objects.at(-1)).toMatchObject({ name: "copy 2", copyOf: 0 });
    expect(after.objectOfFace(6)?.name).toBe("copy 2");
  });
  it("leave what is known of the light", () => {
    const before = new Mirror(3);
    before.apply({ count: 1, face: Uint32Array.of(1), path: Uint32Array.of(2 ** 28), rgb: Float32Array.of(1, 2, 3) });
    const after = new Mirror(5);
    after.takeAll(before);
    expect(after.stateHash).toBe(before.stateHash);
    expect([...after.leaves()]).toEqual([...before.leaves()]);
    expect(after.leafCount).toBe(before.leafCount);
  });
});
