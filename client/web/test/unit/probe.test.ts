import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { ReadMeshResponseSchema, Texture_Wrap, TextureSchema } from "../../src/gen/alvor/v1/scene_service_pb";
import { BaseMesh } from "../../src/mirror/base_mesh";
import { brightnessOf } from "../../src/mirror/brightness";
import { Mirror } from "../../src/mirror/mirror";
import { probe } from "../../src/mirror/probe";
import { LINEAR, type Image } from "../../src/textures/image";

const grey = { name: "grey", emission: { r: 0, g: 0, b: 0 }, reflectance: { r: 0.5, g: 0.5, b: 0.5 } };
const lamp = { name: "lamp", emission: { r: 9, g: 9, b: 9 }, reflectance: { r: 0, g: 0, b: 0 } };

/** A square from (0, 0) to (1, 1) and a triangle beside it, both looking up, far from the origin. */
function mesh(textureCoordinates: number[] = []): BaseMesh {
  const at = [1e6, 0, 0];
  const corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [3, 0, 0], [2, 1, 0]];
  return new BaseMesh([
    create(ReadMeshResponseSchema, {
      cornerCounts: [4, 3],
      materials: [0, 1],
      sceneFaces: [7, 8],
      secondSceneFaces: [10, 0],
      cornerCoordinates: corners.flatMap((corner) => corner.map((x, n) => x + at[n])),
      neighbours: Array<bigint>(7).fill(0n),
      sceneMaterials: [grey, lamp],
      textureCoordinates,
    }),
  ]);
}

/** A square card whose image lies on it from left to right, before a floor of the same size. */
function cardAboveFloor(): BaseMesh {
  const square = (z: number) => [0, 0, z, 1, 0, z, 1, 1, z, 0, 1, z];
  const clamp = Texture_Wrap.CLAMP;
  return new BaseMesh([
    create(ReadMeshResponseSchema, {
      cornerCounts: [4, 4],
      materials: [0, 1],
      sceneFaces: [0, 1],
      cornerCoordinates: [...square(1), ...square(0)],
      neighbours: Array<bigint>(8).fill(0n),
      sceneMaterials: [
        { ...grey, name: "card", texture: { wrapS: clamp, wrapT: clamp } },
        { ...grey, name: "floor", reflectance: { r: 0, g: 0, b: 0 } },
      ],
      textureCoordinates: [0, 0, 1, 0, 1, 1, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0],
    }),
  ]);
}

/** Both roots in four, the n-th child of irradiance n. */
function mirrorOf(base: BaseMesh): Mirror {
  const mirror = new Mirror(base.rootCount);
  const child = (k: number) => (2 * k + 1) * 4 ** 14;
  mirror.apply({
    count: 8,
    face: Uint32Array.from([0, 0, 0, 0, 1, 1, 1, 1]),
    path: Uint32Array.from([0, 1, 2, 3, 0, 1, 2, 3].map(child)),
    slabs: new Uint16Array(8),
    rgb: Float32Array.from([0, 1, 2, 3, 0, 1, 2, 3].flatMap((x) => [x, x, x])),
  });
  return mirror;
}

const down = { x: 0, y: 0, z: -1 };

describe("the probe", () => {
  const base = mesh();
  const mirror = mirrorOf(base);
  const above = (x: number, y: number) => ({ x: x + 1e6 - base.centre[0], y: y - base.centre[1], z: 5 });

  it.each([
    [0.2, 0.2, 7, 0], [0.8, 0.2, 7, 1], [0.2, 0.8, 7, 2], [0.8, 0.8, 7, 3],
    [2.1, 0.1, 8, 0], [2.8, 0.1, 8, 1], [2.1, 0.8, 8, 2], [2.4, 0.4, 8, 3],
  ])("finds the leaf at (%f, %f)", (x, y, face, irradiance) => {
    const reading = probe(base, mirror, above(x, y), down)!;
    // The quad was two triangles of the scene.
    expect(reading.faces).toEqual(face === 7 ? [7, 9] : [8]);
    expect(reading.level).toBe(1);
    expect(reading.irradiance).toEqual([irradiance, irradiance, irradiance]);
    expect(reading.radiosity[0]).toBe(face === 7 ? 0.5 * irradiance : 9);
    expect(reading.place.x).toBeCloseTo(1e6 + x, 6);
  });

  it("reads the texel there once images have come, and their mean until then", () => {
    const textured = mesh([0, 0, 1, 0, 1, 1, 0, 1, 0, 0, 0, 0, 0, 0]);
    textured.materials[0].texture = create(TextureSchema, { wrapS: Texture_Wrap.CLAMP });
    const image = { columns: 2, rows: 1, hasOpacity: false, texels: Uint8Array.of(0, 0, 0, 200, 100, 50) };
    const radiosityAt = (x: number, images?: Image[]) => probe(textured, mirror, above(x, 0.8), down, images)!.radiosity;
    expect(radiosityAt(0.1)).toEqual([1, 1, 1]);
    expect(radiosityAt(0.1, [image])).toEqual([0, 0, 0]);
    [200, 100, 50].forEach((byte, band) => expect(radiosityAt(0.9, [image])[band]).toBeCloseTo(3 * LINEAR[byte], 12));
  });

  it("goes on through holes to what is behind, and reads what is there in part", () => {
    const cutOut = cardAboveFloor();
    const image = { columns: 4, rows: 1, hasOpacity: true, texels: Uint8Array.from([0, 7, 128, 255].flatMap((opacity) => [200, 200, 200, opacity])) };
    const materialAt = (x: number, images?: Image[]) =>
      probe(cutOut, new Mirror(2), { x: x - 0.5, y: 0, z: 5 }, down, images)!.material;
    expect([0.1, 0.3, 0.6, 0.9].map((x) => materialAt(x, [image]))).toEqual(["floor", "floor", "card", "card"]);
    expect(materialAt(0.1)).toBe("card"); // until the image has come
    const { radiosity } = probe(cutOut, mirrorOf(cutOut), { x: 0.2 - 0.5, y: 0.2 - 0.5, z: 5 }, down, [image])!;
    expect(radiosity).toEqual([0, 0, 0]); // the floor's
  });

  it("sees no backs, and nothing beside", () => {
    expect(probe(base, mirror, { ...above(0.5, 0.5), z: -5 }, { x: 0, y: 0, z: 1 })).toBeNull();
    expect(probe(base, mirror, above(1.5, 0.5), down)).toBeNull();
  });
});

describe("automatic exposure", () => {
  it("shows a surface of any brightness alike, and does not look at lamps", () => {
    const base = mesh();
    for (const scale of [1e-6, 1, 1e6]) {
      const mirror = mirrorOf(base);
      for (let n = 0; n < mirror.rgb.length; ++n) mirror.rgb[n] = scale;
      const { exposure, highIrradiance } = brightnessOf(base, mirror, [0, 0, 0]);
      expect(exposure * 0.5 * scale).toBeCloseTo(0.25, 1);
      expect(highIrradiance / scale).toBeCloseTo(1, 1);
    }
  });

  it("is 1 in the dark", () => {
    const base = mesh();
    const dark = mirrorOf(base);
    dark.rgb.fill(0);
    base.materials[1].emission = { $typeName: "alvor.v1.Rgb", r: 0, g: 0, b: 0 };
    expect(brightnessOf(base, dark, [0, 0, 0])).toEqual({ exposure: 1, lowIrradiance: 0, highIrradiance: 0, lowError: 0, highError: 0 });
  });
});
