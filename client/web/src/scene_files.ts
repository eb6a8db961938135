// Scene files that a person drops, as the API's scene. What is read of them, and the words for what is not, are those of `alvor`: client/*_import.cpp.

import type { CreateSceneRequest } from "./gen/alvor/v1/scene_service_pb";
import { DroppedFiles } from "./files/dropped_files";
import { readGltf } from "./files/gltf";
import { MissingParts } from "./files/gltf_file";
import { ImportError } from "./files/import_error";
import { readObj } from "./files/obj";
import { readPly } from "./files/ply";
import type { SceneBuilder } from "./files/scene_builder";
import { readStl } from "./files/stl";

/** A file that is not a scene. The message is one line that names it. */
export class SceneFileError extends Error {}

export interface SceneFile {
  /** Of CreateScene. */
  messages: CreateSceneRequest[];
  /** One sentence each: clamped reflectance, averaged texture, ... */
  warnings: string[];
}

const READERS: Record<string, (files: DroppedFiles) => Promise<SceneBuilder>> = {
  obj: readObj,
  gltf: readGltf,
  glb: readGltf,
  stl: ({ scene }) => readStl(scene),
  ply: ({ scene }) => readPly(scene),
};
// `alvor` reads these through Assimp.
const FOR_ALVOR = ["dae", "fbx", "3ds"];

/** Reads the one scene among the files; the others are its parts. Throws SceneFileError. */
export async function readSceneFiles(files: File[]): Promise<SceneFile> {
  const scene = sceneAmong(files);
  try {
    if (scene.size === 0) throw new ImportError("file", "is empty");
    const builder = await READERS[extensionOf(scene)](new DroppedFiles(files, scene));
    return { messages: builder.messages(scene.name), warnings: builder.warnings };
  } catch (error) {
    throw new SceneFileError(refusalOf(scene.name, error));
  }
}

const extensionOf = (file: File) => /\.([^.]+)$/.exec(file.name)?.[1].toLowerCase() ?? "";

function sceneAmong(files: File[]): File {
  const scenes = files.filter((file) => extensionOf(file) in READERS);
  if (scenes.length === 1) return scenes[0];
  if (scenes.length > 1) throw new SceneFileError(`${listOf(scenes.map(({ name }) => name))} are ${scenes.length} scenes: drop one at a time`);
  const readable = "The page reads OBJ, glTF, GLB, STL and PLY.";
  const foreign = files.find((file) => FOR_ALVOR.includes(extensionOf(file)));
  if (foreign) throw new SceneFileError(`${foreign.name}: only the command 'alvor solve' reads .${extensionOf(foreign)}. ${readable}`);
  throw new SceneFileError(`No scene among these files: ${listOf(files.map(({ name }) => name).slice(0, 5))}. ${readable}`);
}

function refusalOf(name: string, error: unknown): string {
  if (error instanceof MissingParts) {
    const { names } = error;
    return `${name} needs ${listOf(names)}, which ${names.length === 1 ? "was" : "were"} not dropped with it`;
  }
  if (error instanceof ImportError) return `${name}: ${error.message}`;
  // A browser gives a file up when it has changed since it was dropped.
  if (error instanceof DOMException) return `${name}: cannot be read: ${error.message}`;
  return `${name}: is not built as its format asks for`;
}

function listOf(names: string[]): string {
  return names.length < 2 ? names.join() : `${names.slice(0, -1).join(", ")} and ${names.at(-1)}`;
}
