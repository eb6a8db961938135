// The page and the command `alvor` read the same file to the same scene, face by face.

import { execFile } from "node:child_process";
import { readFileSync, readdirSync } from "node:fs";
import { File } from "node:buffer";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";
import { afterAll, beforeAll, expect, it } from "vitest";
import type { GeometryChunk } from "../../src/gen/alvor/v1/scene_service_pb";
import { readSceneFiles } from "../../src/scene_files";
import { Server } from "./server";

const ROOT = new URL("../../../../", import.meta.url);
const ALVOR = process.env.ALVOR ?? fileURLToPath(new URL("build/release/bin/alvor", ROOT));

let server: Server;
beforeAll(async () => {
  server = new Server();
  await server.start();
});
afterAll(() => server?.stop());

/** All files of the folder lie beside the scene. */
async function sentByPage(folder: URL, name: string): Promise<string> {
  const parts = readdirSync(folder).filter((part) => part === name || !/\.(obj|glb|gltf|stl|ply)$/.test(part));
  const files = parts.map((part) => new File([readFileSync(new URL(encodeURIComponent(part), folder))], part));
  const { messages } = await readSceneFiles(files as unknown as Parameters<typeof readSceneFiles>[0]);
  return (await server.api.createScene(messages)).name;
}

async function sentByAlvor(folder: URL, name: string): Promise<string> {
  const known = (await server.api.scenes.listScenes({ pageSize: 1000 })).scenes.map((scene) => scene.name);
  await promisify(execFile)(ALVOR, ["solve", fileURLToPath(new URL(name, folder)), "--server", server.listening, "--tolerance", "0.9"]);
  const { scenes } = await server.api.scenes.listScenes({ pageSize: 1000 });
  return scenes.find((scene) => !known.includes(scene.name))!.name;
}

async function contentOf(name: string) {
  const chunks: GeometryChunk[] = [];
  for await (const { chunk } of server.api.scenes.readScene({ name })) chunks.push(chunk!);
  const vertices = chunks.flatMap((chunk) => chunk.vertexCoordinates);
  const corners = chunks.flatMap((chunk) => chunk.cornerVertices).flatMap((vertex) => vertices.slice(3 * vertex, 3 * vertex + 3));
  const materials = chunks.flatMap((chunk) => chunk.materials);
  return {
    counts: chunks.flatMap((chunk) => chunk.faceCornerCounts),
    names: chunks.flatMap((chunk) => chunk.faceMaterials).map((material) => materials[material].name),
    up: chunks.some((chunk) => chunk.upAxis === 2) ? "z" : "y",
    materials: materials.map(({ name, twoSided }) => ({ name, twoSided })),
    numbers: [...corners, ...materials.flatMap(({ emission: e, reflectance: r }) => [e!.r, e!.g, e!.b, r!.r, r!.g, r!.b])],
  };
}

it.each([
  ...["room.glb", "room.gltf", "room_extras.gltf", "room.obj", "room_z_up.obj", "room.stl", "room.ply"].map((name) => ["tests/import/blender/files/", name]),
  ...["mixed.obj", "textured.obj", "missing_library.obj", "far_away.obj", "two words.obj", "cube.stl", "roof.ply"].map((name) => ["tests/client/good_files/", name]),
  ["scenes/", "cornell_box.obj"],
])("%s%s", async (path, name) => {
  const folder = new URL(path, ROOT);
  const { numbers: byPage, ...page } = await contentOf(await sentByPage(folder, name));
  const { numbers: byAlvor, ...alvor } = await contentOf(await sentByAlvor(folder, name));
  expect(page).toEqual(alvor);
  expect(byPage.length).toBe(byAlvor.length);
  // Both calculate in double; STL and PLY are float in `alvor`, as Assimp reads them.
  const tolerance = /\.(stl|ply)$/.test(name) ? 1e-6 : 1e-12;
  const apart = byPage.map((x, n) => Math.abs(x - byAlvor[n]) / Math.max(1, Math.abs(x)));
  expect(apart.reduce((a, b) => Math.max(a, b), 0)).toBeLessThan(tolerance);
});
