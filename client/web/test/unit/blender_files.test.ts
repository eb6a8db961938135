// What Blender's exporters write, against what Blender says of the room: tests/import/blender/README.md.

import { describe, expect, it } from "vitest";
import { UpAxis } from "../../src/gen/alvor/v1/scene_service_pb";
import { readSceneFiles } from "../../src/scene_files";
import { bytesOf, fileOf } from "./files";
import { bandsOf, materialsOf, measure, upOf } from "./measured_scene";

const FOLDER = "tests/import/blender/files";
const IMAGES = ["floor_checker.png", "leaf.png", "screen.png", "wall paper.png", "wood.png"];
const PARTS: Record<string, string[]> = {
  "room.glb": [],
  "room.gltf": ["room.bin", ...IMAGES],
  "room_extras.gltf": ["room.bin", ...IMAGES],
  "room.obj": ["room.mtl", ...IMAGES],
  "room_z_up.obj": ["room_z_up.mtl", ...IMAGES],
  "room.ply": [],
  "room.stl": [],
};

const expected = JSON.parse(bytesOf(`${FOLDER}/expected.json`).toString());
const figure = (name: string, what: string): number => expected.formats[name].total?.[what] ?? expected.total[what];
const read = (name: string, parts = PARTS[name]) => readSceneFiles([name, ...parts].map((part) => fileOf(`${FOLDER}/${part}`)));

describe.each(Object.keys(PARTS))("%s", (name) => {
  it("has the size that Blender says", async () => {
    const { messages } = await read(name);
    // OBJ does not say which axis points up.
    const measured = measure(messages, expected.formats[name].up === "z" ? UpAxis.Z : UpAxis.Y);
    const area = figure(name, expected.formats[name].triangulated ? "area_m2" : "polygon_area_m2");
    expect(Math.abs(measured.area / area - 1)).toBeLessThan(1e-5);
    expect(Math.abs(measured.signedVolume - figure(name, "signed_volume_m3"))).toBeLessThan(1e-4 * 56);
    expect(measured.triangles).toBe(figure(name, "triangles"));
    const [low, high] = expected.total.bounds_m;
    measured.low.forEach((x, k) => expect(x).toBeCloseTo(low[k], 4));
    measured.high.forEach((x, k) => expect(x).toBeCloseTo(high[k], 4));
  });

  it("says which axis points up, where its format does", async () => {
    const { messages } = await read(name);
    expect(upOf(messages)).toBe(/\.(stl|ply)$/.test(name) ? UpAxis.Z : UpAxis.Y);
  });
});

describe("the room's materials", () => {
  it.each(["room.glb", "room.gltf", "room_extras.gltf"])("shine and reflect in %s as Blender says, textures by their mean", async (name) => {
    const materials = materialsOf((await read(name)).messages);
    const of = (material: string) => materials.find((found) => found.name === material)!;
    for (const lamp of ["Lamp panel", "Night light", "Screen"])
      bandsOf(of(lamp).emission).forEach((band, k) => {
        const radiance: number[] = expected.materials[lamp].emission_linear;
        expect(Math.abs(band - Math.PI * radiance[k])).toBeLessThan(2e-3 * Math.PI * Math.max(...radiance));
      });
    for (const textured of ["Wall paper", "Floor tiles", "Leaf"])
      bandsOf(of(textured).reflectance).forEach((band, k) =>
        expect(Math.abs(band - expected.materials[textured].base_colour_linear[k])).toBeLessThan(2e-3),
      );
  });

  it("count in OBJ by the mean of their textures too", async () => {
    const { messages, warnings } = await read("room.obj");
    const paper = materialsOf(messages).find(({ name }) => name === "Wall_paper")!;
    // The exporter writes no Kd beside a map_Kd, and no Ke beside a map_Ke.
    bandsOf(paper.reflectance).forEach((band, k) => expect(band).toBeCloseTo(expected.materials["Wall paper"].base_colour_linear[k], 3));
    const screen = materialsOf(messages).find(({ name }) => name === "Screen")!;
    expect(screen.emission!.b).toBeGreaterThan(1);
    expect(warnings).toContain("material 'Wall_paper': texture 'wall paper.png' counts by its mean colour");
    const lamp = materialsOf(messages).find(({ name }) => name === "Lamp_panel")!;
    expect(lamp.emission!.r).toBeCloseTo(Math.PI * expected.materials["Lamp panel"].emission_linear[0], 2);
  });

  it("and lights that are not supported are counted", async () => {
    const { warnings } = await read("room.glb");
    for (const said of [
      "1 point light is ignored",
      "1 spot light is ignored",
      "1 directional light is ignored",
      "2 materials with alpha are taken for opaque",
      "1 metallic material is taken for diffuse",
      "1 transmissive material is taken for opaque",
    ])
      expect(warnings.filter((warning) => warning === said), said).toHaveLength(1);
  });
});

describe("parts", () => {
  it("of room.gltf that were not dropped are named, all at once", async () => {
    await expect(read("room.gltf", IMAGES)).rejects.toThrow("room.gltf needs room.bin, which was not dropped with it");
    await expect(read("room.gltf", ["room.bin", "leaf.png", "screen.png", "floor_checker.png"])).rejects.toThrow(
      /^room\.gltf needs (wood\.png and wall paper\.png|wall paper\.png and wood\.png), which were not dropped with it$/,
    );
  });

  it("of room.obj that were not dropped are said, and the rest is read", async () => {
    const { messages, warnings } = await read("room.obj", []);
    expect(warnings[0]).toBe("material library 'room.mtl' cannot be read: not dropped with room.obj");
    expect(warnings).toContain("material 'Wood' is in no material library: grey, reflectance 0.5");
    expect(measure(messages).triangles).toBe(figure("room.obj", "triangles"));
    expect((await read("room.obj", ["room.mtl"])).warnings).toContain(
      "material 'Wall_paper': texture 'wall paper.png' cannot be read and is left out",
    );
  });
});
