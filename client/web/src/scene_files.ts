// Sends the scene files that a person drops to the server, which reads them.

import { ConnectError } from "@connectrpc/connect";
import type { Api, NamedFile } from "./api";
import { MissingFilesSchema, type MissingFiles, type Scene } from "./gen/alvor/v1/scene_service_pb";

/** Files among which no scene can be found. The message is one line that names them. */
export class SceneFileError extends Error {}

/** A scene that names files which were not dropped. */
export class MissingParts extends Error {
  constructor(
    scene: string,
    readonly names: string[],
  ) {
    super(`${scene} needs ${listOf(names)}, which ${names.length === 1 ? "was" : "were"} not dropped with it`);
  }
}

// Extensions of files that a scene names and that are no scenes themselves.
const PARTS = ["mtl", "bin", "png", "jpg", "jpeg", "gif", "bmp", "tga", "webp", "txt", "md"];
// Extensions of scene files that are taken first if several files could be the scene.
const SCENES = ["obj", "gltf", "glb", "stl", "ply", "fbx", "dae", "3ds"];

const extensionOf = (file: File) => /\.([^.]+)$/.exec(file.name)?.[1].toLowerCase() ?? "";

/** The file's path within the dropped folder, or its name alone. */
const pathOf = (file: File): string => file.webkitRelativePath || file.name;

const noSceneAmong = (files: File[]) =>
  new SceneFileError(`No scene among these files: ${listOf(files.map(({ name }) => name).slice(0, 5))}`);

/** Returns the one scene among the files, or nothing if there are only parts of one. Throws SceneFileError. */
function sceneAmong(files: File[]): File | undefined {
  const known = files.filter((file) => SCENES.includes(extensionOf(file)));
  const scenes = known.length > 0 ? known : files.filter((file) => !PARTS.includes(extensionOf(file)));
  if (scenes.length > 1) throw new SceneFileError(`${listOf(scenes.map(({ name }) => name))} are ${scenes.length} scenes: drop one at a time`);
  return scenes[0];
}

/** A scene on its way to the server: the files that were dropped for it so far. */
export class SceneUpload {
  private readonly byPath = new Map<string, File>();
  private readonly folder: string;
  private readonly absent: string[] = [];
  /** The server keeps the files of earlier calls with this id. */
  private readonly requestId = Array.from(crypto.getRandomValues(new Uint32Array(4))).join("-");
  private unsent: NamedFile[];
  private readonly sent: NamedFile[] = [];
  private missing: string[] = [];

  constructor(
    files: File[],
    private readonly scene: File,
  ) {
    this.unsent = [{ name: scene.name, content: scene }];
    const path = pathOf(scene);
    this.folder = path.slice(0, path.lastIndexOf("/") + 1);
    this.add(files);
  }

  /** Adds parts that were missing. */
  add(files: File[]): void {
    for (const file of files) this.byPath.set(pathOf(file), file);
  }

  /** Does without what is missing and was not dropped, where the format allows it. */
  renounce(): void {
    this.absent.push(...this.missing.filter((name) => !this.find(name)));
  }

  /** Sends what the server asks for. Throws MissingParts if it was not dropped, and ConnectError. */
  async send(api: Api): Promise<Scene> {
    for (;;) {
      this.take(this.missing);
      try {
        return await this.sendOnce(api);
      } catch (error) {
        const [detail] = error instanceof ConnectError ? error.findDetails(MissingFilesSchema) : [];
        if (!detail) throw error;
        this.note(detail);
      }
    }
  }

  private sendOnce(api: Api): Promise<Scene> {
    const files = this.unsent;
    this.sent.push(...files);
    this.unsent = [];
    const { name } = this.scene;
    return api.importScene({ sceneFile: name, displayName: name, absentFiles: this.absent }, this.requestId, files);
  }

  private note({ names }: MissingFiles): void {
    this.missing = names;
    if (names.includes(this.scene.name)) {
      // The server has dropped what was sent.
      this.unsent = this.sent.splice(0);
      this.missing = [];
      return;
    }
    const lacking = names.filter((name) => !this.find(name));
    if (lacking.length > 0) throw new MissingParts(this.scene.name, lacking);
  }

  /** Puts what is missing among the files to send, if it was dropped. */
  private take(names: string[]): void {
    for (const name of names) {
      const content = this.find(name);
      if (content) this.unsent.push({ name, content });
    }
    this.missing = [];
  }

  /** Files that were dropped without their folders are found by the name alone. */
  private find(name: string): File | undefined {
    return this.byPath.get(this.folder + name) ?? this.byPath.get(name.slice(name.lastIndexOf("/") + 1));
  }
}

let waiting: SceneUpload | undefined;

/** Sends a scene with its parts, or the parts that the last one lacked. Throws SceneFileError, MissingParts and ConnectError. */
export async function sendSceneFiles(api: Api, files: File[]): Promise<Scene> {
  const scene = sceneAmong(files);
  if (scene) waiting = new SceneUpload(files, scene);
  else if (waiting) waiting.add(files);
  else throw noSceneAmong(files);
  return sendWaiting(api);
}

/** Sends a scene with its parts, all of which are among the files. Throws as sendSceneFiles() does. */
export async function sendSceneAlone(api: Api, files: File[]): Promise<Scene> {
  const scene = sceneAmong(files);
  if (!scene) throw noSceneAmong(files);
  return new SceneUpload(files, scene).send(api);
}

/** Sends the last scene without the parts that it lacks. */
export async function sendWithoutParts(api: Api): Promise<Scene> {
  waiting?.renounce();
  return sendWaiting(api);
}

async function sendWaiting(api: Api): Promise<Scene> {
  try {
    const scene = await waiting!.send(api);
    waiting = undefined;
    return scene;
  } catch (error) {
    if (!(error instanceof MissingParts)) waiting = undefined;
    throw error;
  }
}

function listOf(names: string[]): string {
  return names.length < 2 ? names.join() : `${names.slice(0, -1).join(", ")} and ${names.at(-1)}`;
}
