import { create } from "@bufbuild/protobuf";
import { Code, ConnectError } from "@connectrpc/connect";
import { beforeEach, describe, expect, it } from "vitest";
import type { Api, NamedFile } from "../../src/api";
import { MissingFilesSchema, SceneSchema } from "../../src/gen/alvor/v1/scene_service_pb";
import { MissingParts, SceneFileError, sendSceneFiles, sendWithoutParts } from "../../src/scene_files";

const file = (name: string, path = "") => Object.defineProperty(new File([name], name), "webkitRelativePath", { value: path });

/** What was sent, call by call. */
let sent: { requestId: string; names: string[]; absent: string[] }[];

/** A server that has a scene read which needs these files. */
function serverOfSceneWith(...parts: string[]): Api {
  const here: string[] = [];
  const importScene: Api["importScene"] = async (options, requestId, files: NamedFile[]) => {
    const absent = options.absentFiles ?? [];
    sent.push({ requestId, names: files.map(({ name }) => name), absent: [...absent] });
    here.push(...files.map(({ name }) => name), ...absent);
    const names = parts.filter((name) => !here.includes(name));
    if (names.length > 0) throw withDetails(new ConnectError("needs files", Code.FailedPrecondition), names);
    return create(SceneSchema, { name: "scenes/s1", displayName: options.displayName });
  };
  return { importScene } as Api;
}

/** As an error that came from a server has them. */
function withDetails(error: ConnectError, names: string[]): ConnectError {
  error.findDetails = (() => [create(MissingFilesSchema, { names })]) as unknown as typeof error.findDetails;
  return error;
}

beforeEach(() => (sent = []));

describe("the files of a scene", () => {
  it("are sent as the server asks for them, each once", async () => {
    const files = [file("wood.png"), file("room.gltf"), file("a.bin"), file("unused.png")];
    expect((await sendSceneFiles(serverOfSceneWith("a.bin", "maps/wood.png"), files)).displayName).toBe("room.gltf");
    expect(sent.map(({ names }) => names)).toEqual([["room.gltf"], ["a.bin", "maps/wood.png"]]);
    expect(sent[1].requestId).toBe(sent[0].requestId);
  });

  it("are found in the folder that was dropped", async () => {
    const files = [file("room.obj", "house/room.obj"), file("a.mtl", "house/maps/a.mtl"), file("a.mtl", "other/a.mtl")];
    await sendSceneFiles(serverOfSceneWith("maps/a.mtl"), files);
    expect(sent[1].names).toEqual(["maps/a.mtl"]);
  });

  it("that are missing are named, and may be dropped later", async () => {
    const server = serverOfSceneWith("a.mtl", "wood.png");
    await expect(sendSceneFiles(server, [file("room.obj")])).rejects.toThrow(
      "room.obj needs a.mtl and wood.png, which were not dropped with it",
    );
    await expect(sendSceneFiles(server, [file("a.mtl")])).rejects.toThrow("room.obj needs wood.png, which was not dropped with it");
    await sendSceneFiles(server, [file("wood.png")]);
    expect(sent.at(-1)).toMatchObject({ names: ["wood.png"], absent: [] });
  });

  it("that are missing can be done without", async () => {
    const server = serverOfSceneWith("a.mtl", "wood.png");
    await expect(sendSceneFiles(server, [file("room.obj"), file("a.mtl")])).rejects.toBeInstanceOf(MissingParts);
    await sendWithoutParts(server);
    expect(sent.at(-1)).toMatchObject({ names: ["a.mtl"], absent: ["wood.png"] });
  });

  it("hold one scene", async () => {
    const server = serverOfSceneWith();
    await expect(sendSceneFiles(server, [file("a.png")])).rejects.toThrow("No scene among these files: a.png");
    await expect(sendSceneFiles(server, [file("a.obj"), file("b.glb")])).rejects.toThrow(SceneFileError);
    await sendSceneFiles(server, [file("room.lwo"), file("a.png")]);
    expect(sent.at(-1)!.names).toEqual(["room.lwo"]);
  });
});
