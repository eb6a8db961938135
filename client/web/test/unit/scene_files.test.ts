import { readdirSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { readSceneFiles, SceneFileError } from "../../src/scene_files";
import { bytesOf, file, fileOf } from "./files";
import { bandsOf, chunksOf, facesOf, materialsOf, measure } from "./measured_scene";
import { pngOf } from "./png";

const OBJ = `mtllib a.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
usemtl red
f 1 2 3 4
usemtl lamp
f 1 2 5
usemtl nowhere
f 4 3 5
`;
const MTL = "newmtl red\nKd 0.6 0.1 0.2\nmap_Kd missing.png\nnewmtl lamp\nKd 0 0 0\nKe 2 3 4\n";

const refusal = (...files: Parameters<typeof readSceneFiles>[0]) =>
  readSceneFiles(files).then(
    () => "accepted",
    (error) => (expect(error).toBeInstanceOf(SceneFileError), String(error.message)),
  );
const refusalOf = (name: string, content: string | Uint8Array) => refusal(file(name, content));

/** A glTF of one triangle, whose buffer is a data URI unless `change` names another. */
function gltf(change: Record<string, unknown> = {}, uri?: string): string {
  const corners = Buffer.from(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]).buffer);
  return JSON.stringify({
    asset: { version: "2.0" },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 3, type: "VEC3" }],
    bufferViews: [{ buffer: 0, byteLength: 36 }],
    buffers: [{ byteLength: 36, uri: uri ?? `data:application/octet-stream;base64,${corners.toString("base64")}` }],
    ...change,
  });
}

describe("scene files", () => {
  it("keep their polygons, colours and light, as alvor reads them", async () => {
    const { messages, warnings } = await readSceneFiles([file("a.obj", OBJ), file("a.mtl", MTL)]);
    expect(messages[0].content).toMatchObject({ case: "scene", value: { displayName: "a.obj" } });
    expect(chunksOf(messages)[0].faceCornerCounts).toEqual([4, 3, 3]);
    const [red, lamp, nowhere] = materialsOf(messages);
    expect(red.name).toBe("red");
    expect(bandsOf(red.reflectance)).toEqual([0.6, 0.1, 0.2]);
    expect(lamp.emission!.b).toBeCloseTo(4 * Math.PI);
    expect(nowhere.reflectance!.g).toBe(0.5);
    expect(warnings).toEqual([
      "material 'red': texture 'missing.png' cannot be read and is left out",
      "material 'nowhere' is in no material library: grey, reflectance 0.5",
    ]);
  });

  it("are cut into messages, and keep every face of the examples", async () => {
    for (const name of ["cornell_box", "furnished_room", "slats_and_boxes"]) {
      const text = bytesOf(`scenes/${name}.obj`).toString();
      const { messages } = await readSceneFiles([fileOf(`scenes/${name}.obj`), fileOf(`scenes/${name}.mtl`)]);
      expect(facesOf(messages).length, name).toBe(text.match(/^f /gm)!.length);
    }
    const row = (n: number) => `v 0 0 ${n}\nv 1 0 ${n}\n`;
    const cells = Array.from({ length: 50_000 }, (_, n) => `f ${2 * n + 1} ${2 * n + 2} ${2 * n + 4} ${2 * n + 3}\n`);
    const strip = Array.from({ length: 50_001 }, (_, n) => row(n)).join("") + cells.join("");
    const { messages } = await readSceneFiles([file("strip.obj", strip)]);
    expect(messages.length).toBeGreaterThan(3);
    expect(measure(messages).area).toBeCloseTo(50_000, 6);
  });

  it("keep the number of each face: triangles are not joined", async () => {
    const { messages } = await readSceneFiles([file("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n")]);
    expect(chunksOf(messages)[0].faceCornerCounts).toEqual([3, 3]);
  });

  it("have reflectance of 1 or more taken for 0.95, which is said", async () => {
    const mtl = "newmtl white\nKd 1.2 -0.5 0.5\nnewmtl lamp\nKd 1 1 1\n";
    const obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl white\nf 1 2 3\nusemtl lamp\nf 3 2 1\n";
    const { messages, warnings } = await readSceneFiles([file("a.obj", obj), file("a.mtl", mtl)]);
    expect(materialsOf(messages).map(({ reflectance }) => bandsOf(reflectance))).toEqual([[0.95, 0, 0.5], [0.95, 0.95, 0.95]]);
    expect(warnings).toEqual([
      "material 'white': reflectance 1.2 -0.5 0.5 is clamped to 0.95 0 0.5",
      "material 'lamp': reflectance 1 1 1 is clamped to 0.95 0.95 0.95",
    ]);
    const white = { materials: [{ name: "white" }], meshes: [{ primitives: [{ attributes: { POSITION: 0 }, material: 0 }] }] };
    expect((await readSceneFiles([file("a.gltf", gltf(white))])).warnings).toEqual([
      "1 metallic material is taken for diffuse",
      "material 'white': reflectance 1 1 1 is clamped to 0.95 0.95 0.95",
    ]);
  });

  it("may be those that alvor's own tests read", async () => {
    const folder = "tests/client/good_files";
    const textured = await readSceneFiles(["textured.obj", "colours.mtl", "black_and_white.png"].map((name) => fileOf(`${folder}/${name}`)));
    expect(bandsOf(materialsOf(textured.messages)[0].reflectance)).toEqual([0.25, 0.5, 0.5]);
    expect(textured.warnings).toEqual([
      "material 'checked': texture 'black_and_white.png' counts by its mean colour",
      "material 'lost': texture 'nowhere.png' cannot be read and is left out",
    ]);
    const mixed = await readSceneFiles(["mixed.obj", "colours.mtl"].map((name) => fileOf(`${folder}/${name}`)));
    expect(facesOf(mixed.messages).map(({ corners }) => corners.length)).toEqual([4, 3, 5, 3]);
    expect(facesOf(mixed.messages).map(({ material }) => material.name)).toEqual(["grey", "bright lamp", "grey", "unknown"]);
    expect(mixed.warnings).toEqual([
      "material 'unknown' is in no material library: grey, reflectance 0.5",
      "material 'bright lamp': reflectance 1.2 -0.5 0.5 is clamped to 0.95 0 0.5",
    ]);
    for (const name of ["roof.ply", "cube.stl"]) {
      const [material, ...others] = materialsOf((await readSceneFiles([fileOf(`${folder}/${name}`)])).messages);
      expect([material.name, material.reflectance!.r, others.length], name).toEqual(["default", 0.5, 0]);
    }
  });
});

describe("parts of a scene", () => {
  it("are found by their name alone, or by their folder", async () => {
    const corners = new Uint8Array(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]).buffer);
    const scene = gltf({}, "./parts/my%20corners.bin");
    expect(measure((await readSceneFiles([file("a.gltf", scene), file("my corners.bin", corners)])).messages).area).toBe(0.5);
    const inFolder = (path: string, content: string | Uint8Array) =>
      Object.defineProperty(file(path.slice(path.lastIndexOf("/") + 1), content), "webkitRelativePath", { value: path });
    const dropped = [inFolder("room/a.gltf", scene), inFolder("room/other/my corners.bin", ""), inFolder("room/parts/my corners.bin", corners)];
    expect(measure((await readSceneFiles(dropped)).messages).area).toBe(0.5);
  });

  it("that leave the folder are refused by name", async () => {
    const reason = async (uri: string) => refusalOf("a.gltf", gltf({}, uri));
    expect(await reason("../corners.bin")).toBe("a.gltf: buffer 0 '../corners.bin': leaves the folder of the scene");
    expect(await reason("%2e%2e/corners.bin")).toBe("a.gltf: buffer 0 '../corners.bin': leaves the folder of the scene");
    expect(await reason("/etc/passwd")).toBe("a.gltf: buffer 0 '/etc/passwd': is an absolute path: only files beside the scene are read");
    expect(await reason("https://a.test/b.bin")).toMatch("is a URL or names a drive: only files beside the scene are read");
    expect(await reason("C:\\b.bin")).toMatch("is a URL or names a drive");
  });

  it("may be inside the file", async () => {
    const png = Buffer.from(pngOf({ width: 1, height: 1, depth: 8, kind: 2, rows: [0, 255, 0, 255] })).toString("base64");
    const materials = [{ name: "m", pbrMetallicRoughness: { metallicFactor: 0, baseColorFactor: [0.5, 0.5, 0.5, 1], baseColorTexture: { index: 0 } } }];
    const change = {
      materials,
      textures: [{ source: 0 }],
      images: [{ uri: `data:image/png;base64,${png}` }],
      meshes: [{ primitives: [{ attributes: { POSITION: 0 }, material: 0 }] }],
    };
    const { messages, warnings } = await readSceneFiles([file("a.gltf", gltf(change))]);
    expect(bandsOf(materialsOf(messages)[0].reflectance)).toEqual([0.5, 0, 0.5]);
    expect(warnings).toEqual(["material 'm': texture '0' counts by its mean colour"]);
  });
});

describe("STL", () => {
  const facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

  it("is read as text and as bytes", async () => {
    const text = await readSceneFiles([file("a.stl", `solid a\n${facet}endsolid a\n`)]);
    expect(measure(text.messages).area).toBe(0.5);
    const bytes = new DataView(new ArrayBuffer(84 + 50));
    new Uint8Array(bytes.buffer).set(new TextEncoder().encode("solid, they said"));
    bytes.setUint32(80, 1, true);
    [0, 0, 0, 2, 0, 0, 0, 2, 0].forEach((x, n) => bytes.setFloat32(96 + 4 * n, x, true));
    expect(measure((await readSceneFiles([file("a.STL", new Uint8Array(bytes.buffer))])).messages).area).toBe(2);
  });

  it("that is broken says where", async () => {
    expect(await refusalOf("a.stl", "solid a\nendsolid a\n")).toBe("a.stl: has no faces");
    expect(await refusalOf("a.stl", "solid a\nfacet\nouter loop\nvertex 0 0 zero\n")).toBe("a.stl: line 4: 'zero' is not a finite number");
    expect(await refusalOf("a.stl", "solid a\nfacet\nouter loop\nvertex 0 0 0\n")).toBe("a.stl: ends within a facet");
    expect(await refusalOf("a.stl", bytesOf("tests/import/blender/files/room.stl").subarray(0, 1084))).toBe(
      "a.stl: ends early: it says 767 triangles and holds 20",
    );
    expect(await refusalOf("a.stl", "no STL")).toMatch(/^a\.stl: is neither text STL/);
  });
});

describe("a bad file", () => {
  const room = bytesOf("tests/import/blender/files/room.glb");

  it("is refused by name, with the reason", async () => {
    expect(await refusalOf("a.obj", "v 0 0 0\n")).toBe("a.obj: has no faces");
    expect(await refusalOf("a.obj", "")).toBe("a.obj: is empty");
    expect(await refusalOf("a.obj", "v 0 0 0\nf 1 1 0\n")).toBe("a.obj: face 0: vertex index 0 is out of range, 1 vertices come before it");
    expect(await refusalOf("a.obj", "v 0 0 0\nf 1 1 9\n")).toBe("a.obj: face 0: vertex index 9 is out of range, there are 1 vertices");
    expect(await refusalOf("room.glb", room.subarray(0, 10))).toBe("room.glb: ends within its header");
    expect(await refusalOf("room.glb", room.subarray(0, 1000))).toBe("room.glb: ends within its JSON chunk");
    expect(await refusalOf("room.glb", room.subarray(0, room.length - 8))).toBe("room.glb: ends within its BIN chunk");
    expect(await refusalOf("a.gltf", "{")).toMatch(/^a\.gltf: its JSON is broken/);
    expect(await refusalOf("a.gltf", "[]")).toBe("a.gltf: is not glTF: it has no asset");
    expect(await refusalOf("a.gltf", gltf({ asset: { version: "1.0" } }))).toBe("a.gltf: is glTF of version 1.0, only 2 is supported");
    expect(await refusalOf("a.gltf", gltf({ nodes: 7 }))).toMatch(/^a\.gltf: [a-z0-9 ]+(: [a-z0-9 ]+)?$/);
    expect(await refusalOf("a.gltf", gltf({ buffers: [{ byteLength: 36 }] }))).toBe("a.gltf: buffer 0: names no file");
    expect(await refusalOf("a.gltf", gltf({ accessors: [{ bufferView: 0, componentType: 5126, count: 4, type: "VEC3" }] }))).toBe(
      "a.gltf: accessor 0: ends beyond its bufferView",
    );
    expect(await refusalOf("a.gltf", gltf({ extensionsRequired: ["KHR_draco_mesh_compression"] }))).toBe(
      "a.gltf: requires the extension KHR_draco_mesh_compression, which is not supported",
    );
    expect(await refusalOf("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n")).toBe("a.ply: its header has no end_header");
  });

  it("that is no scene is named with what the page reads", async () => {
    expect(await refusalOf("picture.png", "x")).toBe("No scene among these files: picture.png. The page reads OBJ, glTF, GLB, STL and PLY.");
    expect(await refusalOf("room.fbx", "x")).toBe("room.fbx: only the command 'alvor solve' reads .fbx. The page reads OBJ, glTF, GLB, STL and PLY.");
    expect(await refusal(file("a.obj", OBJ), file("b.stl", "x"))).toBe("a.obj and b.stl are 2 scenes: drop one at a time");
  });

  it("is refused in one line, whichever alvor's tests refuse", async () => {
    const folder = "tests/client/bad_files";
    const libraries = ["bad_colour.mtl", "dark_light.mtl"].map((name) => fileOf(`${folder}/${name}`));
    // These become a scene that the server refuses: it looks at areas and emission.
    const forServer = ["degenerate.obj", "far_out.obj", "dark_light.obj"];
    for (const name of readdirSync(new URL(`../../../../${folder}`, import.meta.url)).filter((name) => !name.endsWith(".mtl"))) {
      const said = await refusal(fileOf(`${folder}/${name}`), ...libraries);
      if (forServer.includes(name)) continue;
      expect(said, name).toMatch(name.endsWith(".txt") ? /^No scene/ : new RegExp(`^${name}: \\S`));
      expect(said, name).not.toMatch(/undefined|\n|Error/);
    }
    expect(await refusal(fileOf(`${folder}/bad_colour.obj`), ...libraries)).toMatch(/^bad_colour\.obj: bad_colour\.mtl line \d+: /);
  });

  it("is refused wherever a GLB ends, without a stack", async () => {
    for (let size = 1; size < room.length; size += 997) expect(await refusalOf("room.glb", room.subarray(0, size))).not.toMatch(/accepted|undefined|\n/);
  });
});
