import { File } from "node:buffer";
import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import type { CreateSceneRequest, GeometryChunk } from "../../src/gen/alvor/v1/scene_service_pb";
import { readSceneFiles, SceneFileError } from "../../src/scene_files";

type BrowserFile = Parameters<typeof readSceneFiles>[0][number];
const file = (name: string, text: string) => new File([text], name) as unknown as BrowserFile;
const chunksOf = (messages: CreateSceneRequest[]) =>
  messages.flatMap(({ content }) => (content.case === "chunk" ? [content.value] : [])) as GeometryChunk[];

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

describe("scene files", () => {
  it("keep their quads, colours and light, as alvor reads them", async () => {
    const messages = await readSceneFiles([file("a.obj", OBJ), file("a.mtl", MTL)]);
    expect(messages[0].content).toMatchObject({ case: "scene", value: { displayName: "a.obj" } });
    const [chunk] = chunksOf(messages);
    expect(chunk.faceCornerCounts).toEqual([4, 3, 3]);
    const [red, lamp, nowhere] = chunk.materials;
    expect(red.name).toBe("red");
    expect([red.reflectance!.r, red.reflectance!.g, red.reflectance!.b]).toEqual([0.6, 0.1, 0.2]);
    expect(lamp.emission!.b).toBeCloseTo(4 * Math.PI);
    expect(nowhere.reflectance!.g).toBe(0.5);
  });

  it("are cut into messages, and keep every quad of the examples", async () => {
    const read = (name: string) => readFileSync(new URL(`../../../../scenes/${name}`, import.meta.url), "utf8");
    for (const name of ["cornell_box", "furnished_room", "slats_and_boxes"]) {
      const text = read(`${name}.obj`);
      const messages = await readSceneFiles([file(`${name}.obj`, text), file(`${name}.mtl`, read(`${name}.mtl`))]);
      const faces = chunksOf(messages).flatMap((chunk) => chunk.faceCornerCounts);
      expect(faces.length, name).toBe(text.match(/^f /gm)!.length);
    }
  });

  it("without faces are refused by name", async () => {
    await expect(readSceneFiles([file("a.obj", "v 0 0 0\n")])).rejects.toThrow(new SceneFileError("a.obj: has no faces"));
    await expect(readSceneFiles([file("a.txt", "")])).rejects.toThrow(SceneFileError);
  });
});
