// Mirrors one solve, or reads one solution, away from the page's thread: it is decoded and made ready to be drawn here.

import { Code, ConnectError } from "@connectrpc/connect";
import { connect, mayPass, reasonOf, sceneOf, type Api } from "./api";
import type { ReadMeshResponse } from "./gen/alvor/v1/scene_service_pb";
import { Detail, type Look, type WatchSolveResponse } from "./gen/alvor/v1/solve_service_pb";
import type { Counters, FromWorker, ToWorker } from "./messages";
import { BaseMesh } from "./mirror/base_mesh";
import { addedObjects, addedScenes, withAdded } from "./mirror/copies";
import { brightnessOf } from "./mirror/brightness";
import { decodeErrors } from "./mirror/errors";
import { BadFrame, decodeLeaves } from "./mirror/leaves";
import { Mirror } from "./mirror/mirror";
import { partsOf } from "./mirror/parts";
import { probe } from "./mirror/probe";
import { Surface } from "./mirror/surface";
import { readSolution } from "./solution_file";
import type { Image } from "./textures/image";
import { readImages } from "./textures/reading";
import { piecesOf, sheetFor, tableOf } from "./textures/sheet";

const tell = (message: FromWorker, transfer: Transferable[] = []) => postMessage(message, { transfer });
const now = () => performance.timeOrigin + performance.now();
const pause = (ms: number) => new Promise((resolve) => setTimeout(resolve, ms));

const LONGEST_UNSEEN_MS = 250; // a state of many pages is shown in parts
const LONGEST_WAIT_MS = 5000;
const LONGEST_SILENCE_MS = 30_000; // there is a bookmark every ten seconds

/** Returns the tables of materials that the shaders read: see materialTable(). */
function tablesOf(mesh: BaseMesh): { materials: Float32Array; transmittances?: Float32Array } {
  const materials = Float32Array.from(
    mesh.materials.flatMap(({ emission: e, reflectance: r, regularTransmittance: t }) => {
      const through = t ? (t.r + t.g + t.b) / 3 : 0;
      return [e!.r, e!.g, e!.b, through, r!.r, r!.g, r!.b, 0];
    }),
  );
  const transmittances = mesh.isTranslucent
    ? Float32Array.from(mesh.materials.flatMap(({ diffuseTransmittance: t }) => [t?.r ?? 0, t?.g ?? 0, t?.b ?? 0, 0, 0, 0, 0, 0]))
    : undefined;
  return { materials, transmittances };
}

/** What is drawn: a mesh, the light on it, and its textures. */
abstract class Shown {
  protected mesh!: BaseMesh;
  /** The mesh as submitted. */
  private messages: ReadMeshResponse[] = [];
  protected mirror!: Mirror;
  private surface!: Surface;
  /** Of the mesh's textures, when they have come. */
  private images?: Image[];
  /** The meshes of scenes that edits have added, by name. */
  protected readonly scenes = new Map<string, ReadMeshResponse[]>();
  /** The scenes whose images were asked for; undefined before any were. */
  private imagesAsked?: string;
  protected look: Pick<Look, "objects" | "edits"> = { objects: [], edits: 0n };
  protected ambient: [number, number, number] = [0, 0, 0];
  private isDrawn = true;
  protected isChanged = false;
  protected shownAt = 0;
  protected readonly counters: Counters = { revision: 0, bytes: 0, arrived: 0, applying: 0, preparing: 0 };

  constructor(private readonly longestSide: number) {}

  abstract run(): Promise<void>;
  /** `added`: the scenes that edits have added. */
  protected abstract readImages(added: string[]): Promise<Image[]>;

  drawn(): void {
    this.isDrawn = true;
    this.show();
  }

  probe(message: Extract<ToWorker, { kind: "probe" }>): void {
    const reading = this.mirror ? probe(this.mesh, this.mirror, message.origin, message.direction, this.images) : null;
    tell({ kind: "probed", reading });
  }

  protected setMesh(messages: ReadMeshResponse[]): void {
    this.messages = messages;
    this.look = { objects: [], edits: 0n };
    this.mesh = new BaseMesh(messages);
    this.forget();
    this.tellMesh();
  }

  private tellMesh(): void {
    const { centre, extent, isZUp, isPhotometric } = this.mesh;
    const counts = Uint8Array.from({ length: this.mesh.rootCount }, (_, root) => this.mesh.cornersOf(root));
    const corners = Float32Array.from(this.mesh.corners);
    tell({ kind: "mesh", centre, extent, corners, counts, isZUp, isPhotometric, parts: partsOf(this.mesh), ...tablesOf(this.mesh) });
  }

  /** Shows how edits have made surfaces look. Requires: `scenes` has the scenes that were added. */
  protected setLook(look: Look): void {
    const [added, before] = [addedObjects(look), addedObjects(this.look)];
    const isAsBefore = added.length === before.length && added.every(({ name }, n) => name === before[n].name);
    this.look = look;
    if (!isAsBefore) this.setObjects(withAdded(this.messages, look, this.scenes));
    const { relit, moved } = this.mesh.applyLook(look);
    this.surface.onMaterials(relit);
    this.surface.onMoved(moved);
    this.surface.onTransmittances();
    tell({ kind: "look", ...tablesOf(this.mesh) });
    this.isChanged = true;
  }

  /** Edits have added objects. What is known of the light stays. */
  private setObjects(messages: ReadMeshResponse[]): void {
    const before = this.mirror;
    this.mesh = new BaseMesh(messages, this.messages.length); // what was added may lie anywhere before it is moved
    this.beginMirror();
    this.mirror.takeAll(before);
    this.tellMesh();
  }

  private beginMirror(): void {
    this.surface = new Surface(this.mesh);
    this.mirror = new Mirror(this.mesh.rootCount, this.surface, (root) => this.mesh.cornersOf(root) === 3);
    this.surface.attach(this.mirror);
  }

  protected forget(): void {
    this.beginMirror();
  }

  protected count(began: number): void {
    const { counters } = this;
    counters.arrived = performance.timeOrigin + began;
    counters.applying = performance.now() - began;
  }

  /** What changed, once what was sent before is on the screen. */
  protected show(): void {
    if (!this.isDrawn || !this.isChanged) return;
    this.isDrawn = this.isChanged = false;
    this.shownAt = now();
    const began = performance.now();
    const change = this.surface.flush();
    const brightness = brightnessOf(this.mesh, this.mirror, this.ambient);
    this.counters.preparing = performance.now() - began;
    const { positions, coordinates, colours, values, transmitted, errors, triangles } = change;
    const parts = [positions, coordinates, colours, values, transmitted, errors, triangles];
    const buffers = parts.flatMap((part) => (part ? [part.ranges.buffer, part.data.buffer] : []));
    tell({ kind: "change", change, brightness, counters: { ...this.counters } }, buffers);
    void this.showImages(); // not before: the first light needs none
  }

  /** Reads the images of the textures, once until further ones are added, and sends them to the page. */
  private async showImages(): Promise<void> {
    const added = addedScenes(this.look);
    if (this.imagesAsked === added.join() || !this.mesh.hasTextures) return;
    this.imagesAsked = added.join();
    try {
      const images = await this.readImages(added);
      if (this.imagesAsked !== added.join()) return; // others have been asked for since
      this.images = images;
      await this.sendSheet(images, () => this.imagesAsked === added.join());
    } catch (error) {
      tell({ kind: "no images", reason: reasonOf(error) });
    }
  }

  private async sendSheet(images: Image[], isWanted: () => boolean): Promise<void> {
    const sheet = sheetFor(images, this.longestSide);
    if (!sheet) throw new Error("the graphics card does not hold so many texels");
    const table = tableOf(this.mesh.materials, images);
    tell({ kind: "sheet", sheet, table }, [table.buffer]);
    for (const piece of piecesOf(images, sheet)) {
      if (!isWanted()) return; // another sheet has begun
      tell({ kind: "piece", piece }, [piece.texels.buffer]);
      await pause(0); // for frames that came meanwhile
    }
  }
}

class Watch extends Shown {
  private epoch = "";
  private revision = 0n;
  private isWhole = true;
  private hasEnded = false;
  private silence?: ReturnType<typeof setTimeout>;
  private readonly api: Api;
  private readonly solve: string;
  private readonly rate: number;

  constructor({ origin, token, solve, rate, longestSide }: Extract<ToWorker, { kind: "watch" }>) {
    super(longestSide);
    this.api = connect(
      origin,
      () => token,
      (count) => (this.counters.bytes += count),
    );
    this.solve = solve;
    this.rate = rate;
  }

  async run(): Promise<void> {
    for (let wait = 100, lost = false; ; wait = Math.min(2 * wait, LONGEST_WAIT_MS)) {
      try {
        if (!this.mesh) this.setMesh(await this.readMesh(sceneOf(this.solve)));
        const onFirst = () => {
          this.tellConnected(lost);
          wait = 100;
          lost = false;
        };
        await this.follow(onFirst);
        lost = true;
      } catch (error) {
        if (!this.canTryAgain(error)) throw error;
        tell({ kind: "connection", state: "lost", reason: reasonOf(error) });
        lost = true;
      }
      await pause(wait);
    }
  }

  protected async readImages(added: string[]): Promise<Image[]> {
    const images = await readImages(this.api, sceneOf(this.solve));
    for (const scene of added) images.push(...(await readImages(this.api, scene)));
    return images;
  }

  private async readMesh(scene: string, onMessage = () => {}, signal?: AbortSignal): Promise<ReadMeshResponse[]> {
    const messages = [];
    for await (const message of this.api.scenes.readMesh({ name: scene }, { signal })) {
      messages.push(message);
      onMessage();
    }
    return messages;
  }

  /** Reads the meshes of scenes that a look tells were added, where they are not known yet. Gives up after a long silence. */
  private async readAdded(look: Look, givenUp: AbortController): Promise<void> {
    for (const scene of addedScenes(look))
      if (!this.scenes.has(scene)) this.scenes.set(scene, await this.readMesh(scene, () => this.limitSilence(givenUp), givenUp.signal));
  }

  private limitSilence(givenUp: AbortController): void {
    clearTimeout(this.silence);
    this.silence = setTimeout(() => givenUp.abort(), LONGEST_SILENCE_MS);
  }

  protected override forget(): void {
    super.forget();
    this.revision = 0n;
    this.isWhole = true;
    this.hasEnded = false;
  }

  private canTryAgain(error: unknown): boolean {
    if (error instanceof BadFrame) {
      this.forget();
      return true;
    }
    return mayPass(error);
  }

  private tellConnected(wasLost: boolean): void {
    const state = !wasLost ? "connected" : this.revision > 0n ? "resumed" : "begun anew";
    tell({ kind: "connection", state, reason: `revision ${this.revision}` });
  }

  /** Until the server closes the watch. */
  private async follow(onFirst: () => void): Promise<void> {
    if (!this.isWhole) this.forget(); // between two revisions: equal to none that a server knows
    const givenUp = new AbortController();
    try {
      await this.takeFrames(givenUp, onFirst);
    } finally {
      clearTimeout(this.silence);
      givenUp.abort(); // a stream that nobody reads would hold its connection, of which there are six
    }
  }

  private async takeFrames(givenUp: AbortController, onFirst: () => void): Promise<void> {
    const request = {
      name: this.solve,
      epoch: this.epoch,
      baseRevision: this.revision,
      detail: Detail.DISPLAY,
      maxRateHertz: this.rate,
      withErrors: true,
      followEdits: true,
    };
    let count = 0n;
    for await (const frame of this.api.solves.watchSolve(request, { signal: givenUp.signal })) {
      this.limitSilence(givenUp);
      if (++count === 1n) onFirst();
      if (frame.closing) {
        tell({ kind: "connection", state: "closing", reason: frame.closing.reason });
        return;
      }
      if (frame.look) await this.readAdded(frame.look, givenUp);
      this.take(frame);
      if (frame.ended && !this.hasEnded) {
        this.show();
        tell({ kind: "ended", isShown: !this.isChanged });
      }
      this.hasEnded = frame.ended;
      // Of a frame that is not acknowledged the server would wait for ever; a watch that broke off meanwhile needs no answer.
      this.api.solves
        .acknowledgeFrame({ watchId: frame.watchId, revision: frame.toRevision, frameCount: count })
        .catch((error) => ConnectError.from(error).code === Code.NotFound || givenUp.abort());
    }
    throw new ConnectError("the stream broke off", Code.Unavailable);
  }

  private take(frame: WatchSolveResponse): void {
    const began = performance.now();
    if (frame.reset) {
      this.forget();
      tell({ kind: "connection", state: "begun anew", reason: "the server does not know what was seen so far" });
    }
    if (frame.fromRevision !== this.revision) throw new BadFrame("a frame does not follow the one before it");
    const isFirst = this.revision === 0n;
    if (frame.look) {
      this.hasEnded = false; // the page takes a solve that was edited as going on, until it is told otherwise
      this.setLook(frame.look);
    }
    if (frame.leaves && frame.leaves.count > 0) {
      this.mirror.apply(decodeLeaves(frame.leaves));
      this.isChanged = true;
    }
    this.epoch = frame.epoch;
    this.isWhole = frame.toRevision === frame.headRevision || (frame.leaves?.count ?? 0) === 0 || frame.toRevision > this.revision;
    this.revision = frame.toRevision;
    if (frame.steps.some(({ edits }) => edits > this.look.edits)) throw new BadFrame("a state heeds edits of which no look has told");
    if (frame.stateHash !== undefined && frame.stateHash !== this.mirror.stateHash)
      throw new BadFrame("the state has another hash than the server's");
    if (frame.errors) {
      this.mirror.takeErrors(decodeErrors(frame.errors));
      this.isChanged = true;
    }
    if (frame.steps.length > 0) {
      const { r, g, b } = frame.steps.at(-1)!.ambientIrradiance ?? { r: 0, g: 0, b: 0 };
      this.ambient = [r, g, b];
      tell({ kind: "steps", steps: frame.steps, isFirst });
    }
    this.counters.revision = Number(this.revision);
    this.count(began);
    if (this.isWhole || now() - this.shownAt > LONGEST_UNSEEN_MS) this.show();
  }
}

/** A solution that was written to a file. */
class Opened extends Shown {
  private readonly file: Blob;
  private readonly fileImages: Image[] = [];

  constructor({ file, longestSide }: Extract<ToWorker, { kind: "open" }>) {
    super(longestSide);
    this.file = file;
  }

  async run(): Promise<void> {
    const bytes = new Uint8Array(await this.file.arrayBuffer());
    const began = performance.now();
    const { mesh, leaves, errors, images } = readSolution(bytes);
    this.fileImages.push(...images);
    this.counters.bytes = bytes.length;
    this.setMesh(mesh);
    for (const part of leaves) this.mirror.apply(decodeLeaves(part));
    for (const part of errors) this.mirror.takeErrors(decodeErrors(part));
    this.count(began);
    this.isChanged = true;
    this.show();
    tell({ kind: "ended", isShown: !this.isChanged });
  }

  protected async readImages(): Promise<Image[]> {
    return this.fileImages;
  }
}

let shown: Shown | undefined;

onmessage = ({ data }: MessageEvent<ToWorker>) => {
  if (data.kind === "drawn") shown?.drawn();
  if (data.kind === "probe") shown?.probe(data);
  if (data.kind !== "watch" && data.kind !== "open") return;
  shown = data.kind === "watch" ? new Watch(data) : new Opened(data);
  shown.run().catch((error) => {
    const needsToken = ConnectError.from(error).code === Code.Unauthenticated;
    tell({ kind: "refused", reason: reasonOf(error), needsToken });
  });
};
