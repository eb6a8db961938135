import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { LightSchema, Light_Kind, MaterialSchema, Quantity, ReadMeshResponseSchema, UpAxis } from "../../src/gen/alvor/v1/scene_service_pb";
import { LookOfObjectSchema } from "../../src/gen/alvor/v1/solve_service_pb";
import { BaseMesh } from "../../src/mirror/base_mesh";
import { addedScenes, withAdded } from "../../src/mirror/copies";
import { partsOf } from "../../src/mirror/parts";
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

const material = (image: number | undefined) => create(MaterialSchema, { texture: image === undefined ? undefined : { image } });

describe("added objects", () => {
  it("have copies of the root patches of another, and of those that hang from it", () => {
    const copied = withAdded(messages, { objects: [copy(2, 0, 4, 3), copy(3, 1, 7, 2)] });
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
    expect(withAdded(messages, { objects: [create(LookOfObjectSchema, { number: 0, hidden: true })] })).toBe(messages);
  });
  it("make a mesh whose other root patches and middle are as before", () => {
    const before = new BaseMesh(messages);
    const after = new BaseMesh(withAdded(messages, { objects: [copy(2, 0, 4, 3)] }));
    expect(after.rootCount).toBe(5);
    expect(after.centre).toEqual(before.centre);
    expect([...after.corners.subarray(0, before.corners.length)]).toEqual([...before.corners]);
    expect(after.objects.at(-1)).toMatchObject({ name: "copy 2", copyOf: 0 });
    expect(after.objectOfFace(6)?.name).toBe("copy 2");
  });
  it("may be all of another scene, with its materials and images", () => {
    const textured = create(ReadMeshResponseSchema, {
      cornerCounts: [3],
      materials: [1],
      sceneFaces: [0],
      secondSceneFaces: [0],
      cornerCoordinates: [0, 0, 0, 1, 0, 0, 0, 2, 3],
      neighbours: [0n, across(0, 2), across(0, 1)],
      textureCoordinates: [0, 0, 1, 0, 0.5, 1],
      sceneMaterials: [{ name: "oak" }, { name: "leaf", texture: { image: 0 } }],
      sceneObjects: [{ name: "leaves", firstFace: 0, faceCount: 1 }],
      upAxis: UpAxis.Z,
    });
    const object = create(LookOfObjectSchema, { number: 2, name: "plant", firstFace: 4, faceCount: 1, fromScene: "scenes/p", firstMaterial: 3 });
    const own = messages.map((message, n) => ({ ...message, sceneMaterials: n === 0 ? [material(0), material(undefined), material(2)] : [] }));
    const all = withAdded(own, { objects: [object, { ...object, number: 3, name: "second", firstFace: 5, firstMaterial: 5 }] }, new Map([["scenes/p", [textured]]]));
    const added = all[2];
    expect(added.materials).toEqual([4]);
    expect(added.sceneFaces).toEqual([4]);
    expect(added.secondSceneFaces).toEqual([0]);
    expect(added.cornerCoordinates).toEqual([0, 0, -0, 1, 0, -0, 0, 3, -2]); // y points up
    expect(added.neighbours).toEqual([0n, across(3, 2), across(3, 1)]);
    expect(added.sceneMaterials.map(({ name, texture }) => [name, texture?.image])).toEqual([["oak of plant", undefined], ["leaf of plant", 3]]);
    const mesh = new BaseMesh(all);
    expect(mesh.rootCount).toBe(5);
    expect(mesh.hasTextures).toBe(true);
    expect(mesh.materials[mesh.material[4]].name).toBe("leaf of second");
    expect(mesh.materials[mesh.material[4]].texture?.image).toBe(4);
    expect(mesh.objects.slice(2).map(({ name, fromScene }) => [name, fromScene])).toEqual([["plant", "scenes/p"], ["second", "scenes/p"]]);
    expect(mesh.objectOfFace(5)?.name).toBe("second");
    expect(addedScenes({ objects: [object, copy(3, 0, 5, 3)] })).toEqual(["scenes/p"]);
    expect(textured.sceneMaterials[1].texture?.image).toBe(0); // it may be added again
    const before = new BaseMesh(own);
    const framed = new BaseMesh(all, own.length);
    expect([framed.centre, framed.extent]).toEqual([before.centre, before.extent]); // wherever what was added lies
    expect(partsOf(framed)).toMatchObject({ low: partsOf(before).low, high: partsOf(before).high });
  });
  it("bring the lights of their scene, also to copies of them", () => {
    const lamp = create(ReadMeshResponseSchema, {
      cornerCounts: [3],
      materials: [0],
      sceneFaces: [0],
      secondSceneFaces: [0],
      cornerCoordinates: [0, 0, 0, 1, 0, 0, 0, 2, 3],
      neighbours: [0n, 0n, 0n],
      sceneMaterials: [{ name: "wood" }],
      sceneLights: [{ name: "bulb", kind: Light_Kind.POINT, intensity: { r: 1, g: 2, b: 3 } }],
    });
    const own = [{ ...messages[0], sceneLights: [create(LightSchema, { name: "sun", kind: Light_Kind.DIRECTIONAL })] }, messages[1]];
    const object = create(LookOfObjectSchema, { number: 2, name: "lamp", firstFace: 4, faceCount: 1, fromScene: "scenes/l", firstMaterial: 0 });
    const mesh = new BaseMesh(withAdded(own, { objects: [object, copy(3, 2, 5, 1)] }, new Map([["scenes/l", [lamp]]])), own.length);
    const intensity = [1, 2, 3];
    expect(partsOf(mesh).lights).toEqual([
      { name: "sun", intensity: [0, 0, 0], isFar: true, position: undefined },
      { name: "bulb of lamp", intensity, isFar: false, addedWith: "lamp" },
      { name: "bulb of copy 3", intensity, isFar: false, addedWith: "copy 3" },
    ]);
    expect(partsOf(mesh).objects.map(({ name, shines }) => [name, shines])).toEqual([["thing", false], ["part", false], ["lamp", true], ["copy 3", true]]);
    expect(lamp.sceneLights[0].name).toBe("bulb"); // it may be added again
    const inLumens = [{ ...own[0], quantity: Quantity.PHOTOMETRIC }, own[1]];
    const converted = new BaseMesh(withAdded(inLumens, { objects: [object] }, new Map([["scenes/l", [lamp]]])));
    expect(partsOf(converted).lights.at(-1)?.intensity).toEqual([179, 358, 537]);
  });
  it("leave what is known of the light", () => {
    const before = new Mirror(3);
    before.apply({ count: 1, face: Uint32Array.of(1), path: Uint32Array.of(2 ** 28), slabs: new Uint16Array(1), rgb: Float32Array.of(1, 2, 3) });
    const after = new Mirror(5);
    after.takeAll(before);
    expect(after.stateHash).toBe(before.stateHash);
    expect([...after.leaves()]).toEqual([...before.leaves()]);
    expect(after.leafCount).toBe(before.leafCount);
  });
});
