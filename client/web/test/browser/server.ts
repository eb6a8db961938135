// An alvord of a test's own, with the page.

import { spawn, type ChildProcess } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { create } from "@bufbuild/protobuf";
import { connect, type Api } from "../../src/api";
import { CreateSceneRequestSchema, type Scene } from "../../src/gen/alvor/v1/scene_service_pb";

const ALVORD = process.env.ALVORD ?? new URL("../../../../build/release/bin/alvord", import.meta.url).pathname;

export class Server {
  private process!: ChildProcess;
  private readonly data = mkdtempSync(join(tmpdir(), "alvor-page-"));
  private address = "127.0.0.1:0";
  url = "";
  /** HOST:PORT of gRPC. */
  listening = "";
  log = "";

  /** Again at the same address, when it was killed. */
  async start(): Promise<void> {
    this.process = spawn(ALVORD, ["--listen", "127.0.0.1:0", "--web", this.address, "--data", this.data, "--checkpoint-interval", "0.2"]);
    this.url = await new Promise<string>((resolve, reject) => {
      this.process.once("exit", (code) => reject(new Error(`alvord ended with ${code}: ${this.log}`)));
      this.process.stderr!.on("data", (chunk) => {
        this.log += chunk;
        const found = /web page on (http:\S+)[^]*listening on/.exec(String(this.log.slice(this.log.lastIndexOf("web page on"))));
        if (!found) return;
        this.listening = /listening on (\S+)/.exec(this.log.slice(this.log.lastIndexOf("listening on")))![1];
        resolve(found[1]);
      });
    });
    this.address = new URL(this.url).host;
  }

  get api(): Api {
    return connect(this.url.slice(0, -1), () => "");
  }

  get pid(): number {
    return this.process.pid!;
  }

  kill(): Promise<void> {
    return this.end("SIGKILL");
  }

  async stop(): Promise<void> {
    await this.end("SIGTERM");
    rmSync(this.data, { recursive: true, force: true });
  }

  private end(signal: NodeJS.Signals): Promise<void> {
    this.process.removeAllListeners("exit");
    const ended = new Promise<void>((resolve) => this.process.once("exit", () => resolve()));
    this.process.kill(signal);
    return ended;
  }
}

export interface Quad {
  corners: [number, number, number][];
  emission?: [number, number, number];
  reflectance?: [number, number, number];
}

/** Each quad is of a material of its own. */
export async function createScene(api: Api, quads: Quad[]): Promise<Scene> {
  const rgb = ([r, g, b]: [number, number, number]) => ({ r, g, b });
  const first = create(CreateSceneRequestSchema, { content: { case: "scene", value: { displayName: "made by a test" } } });
  const kinds = new Map<string, number>();
  const kindOf = (quad: Quad) => JSON.stringify([quad.emission ?? [0, 0, 0], quad.reflectance ?? [0.5, 0.5, 0.5]]);
  for (const quad of quads) if (!kinds.has(kindOf(quad))) kinds.set(kindOf(quad), kinds.size);
  const chunk = create(CreateSceneRequestSchema, {
    content: {
      case: "chunk",
      value: {
        materials: [...kinds.keys()].map((kind) => {
          const [emission, reflectance] = JSON.parse(kind);
          return { name: kind, emission: rgb(emission), reflectance: rgb(reflectance) };
        }),
        vertexCoordinates: quads.flatMap((quad) => quad.corners.flat()),
        faceCornerCounts: quads.map(() => 4),
        faceMaterials: quads.map((quad) => kinds.get(kindOf(quad))!),
        cornerVertices: quads.flatMap((_, n) => [4 * n, 4 * n + 1, 4 * n + 2, 4 * n + 3]),
      },
    },
  });
  return api.createScene([first, chunk]);
}
