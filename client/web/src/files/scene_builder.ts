// What the readers of scene files put together: the messages of CreateScene.

import { create } from "@bufbuild/protobuf";
import { CreateSceneRequestSchema, UpAxis, type CreateSceneRequest, type GeometryChunk } from "../gen/alvor/v1/scene_service_pb";
import { ImportError } from "./import_error";
import type { Bands } from "./texture_colour";

// As in import/scene_file.cpp and client/placement.h.
const CLAMPED_REFLECTANCE = 0.95;
export const DEFAULT_REFLECTANCE: Bands = [0.5, 0.5, 0.5];

// A message stays well below the 4 MB that gRPC takes: a vertex has 24 bytes.
const CHUNK_FACES = 20_000;
const CHUNK_VERTICES = 60_000;
// A file of some kilobytes can place a mesh any number of times; a tab holds about so much.
const MOST_CORNERS = 50_000_000;
const LONGEST_WARNING = 400;

export interface SceneMaterial {
  name: string;
  /** W/m2 sr per band: the server is told pi times that. */
  radiance: Bands;
  reflectance: Bands;
  twoSided: boolean;
}

export class SceneBuilder {
  readonly materials: SceneMaterial[] = [];
  /** One sentence each. */
  readonly warnings: string[] = [];
  up = UpAxis.Y;
  private readonly chunks: GeometryChunk[] = [];
  private readonly requests: CreateSceneRequest[] = [];
  private chunk = this.newChunk();
  private corners = 0;
  vertexCount = 0;
  faceCount = 0;

  /** Returns the vertex's index. */
  addVertex(x: number, y: number, z: number): number {
    if (this.chunk.vertexCoordinates.length >= 3 * CHUNK_VERTICES) this.chunk = this.newChunk();
    this.chunk.vertexCoordinates.push(x, y, z);
    return this.vertexCount++;
  }

  addFace(vertices: number[], material: number): void {
    if (this.chunk.faceCornerCounts.length >= CHUNK_FACES) this.chunk = this.newChunk();
    if ((this.corners += vertices.length) > MOST_CORNERS) throw new ImportError("scene", `has more than ${MOST_CORNERS} corners`);
    this.chunk.faceCornerCounts.push(vertices.length);
    this.chunk.faceMaterials.push(material);
    for (const vertex of vertices) this.chunk.cornerVertices.push(vertex);
    ++this.faceCount;
  }

  /** Returns the material's index. */
  addMaterial(material: SceneMaterial): number {
    return this.materials.push(material) - 1;
  }

  /** Adds the grey of faces that name no material, and returns its index. */
  addDefaultMaterial(): number {
    return this.addMaterial({ name: "default", radiance: [0, 0, 0], reflectance: [...DEFAULT_REFLECTANCE], twoSided: false });
  }

  /** Returns for each material whether any face has it. */
  usedMaterials(): boolean[] {
    const used = this.materials.map(() => false);
    for (const chunk of this.chunks) for (const material of chunk.faceMaterials) used[material] = true;
    return used;
  }

  /** Throws ImportError for the first face that names a vertex which does not exist. `first` is what the file calls vertex 0. */
  refuseVerticesBeyond(first: 0 | 1): void {
    let face = 0;
    for (const { cornerVertices, faceCornerCounts } of this.chunks) {
      let corner = 0;
      for (const count of faceCornerCounts) {
        for (const end = corner + count; corner < end; ++corner) this.refuseVertex(cornerVertices[corner], face, first);
        ++face;
      }
    }
  }

  private refuseVertex(vertex: number, face: number, first: number): void {
    if (vertex < this.vertexCount) return;
    throw new ImportError(`face ${face}`, `vertex index ${vertex + first} is out of range, there are ${this.vertexCount} vertices`);
  }

  /** Closes the scene. Throws ImportError where it has no faces. */
  messages(name: string): CreateSceneRequest[] {
    if (this.faceCount === 0) throw new ImportError("scene", "has no faces");
    this.clampReflectances();
    this.warnings.forEach((warning, n) => (this.warnings[n] = oneLine(warning)));
    this.chunks[0].upAxis = this.up;
    for (const { name, radiance, reflectance, twoSided } of this.materials)
      this.chunks[0].materials.push({
        $typeName: "alvor.v1.Material",
        name,
        emission: rgb(radiance.map((band) => Math.PI * band) as Bands),
        reflectance: rgb(reflectance),
        twoSided,
      });
    const first = create(CreateSceneRequestSchema, {
      content: { case: "scene", value: { displayName: name } },
      requestId: crypto.randomUUID?.() ?? String(Math.random()),
    });
    return [first, ...this.requests];
  }

  private clampReflectances(): void {
    for (const material of this.materials) {
      const given = material.reflectance;
      if (!given.every(Number.isFinite)) continue; // the server refuses it by name
      material.reflectance = given.map((band) => (band < 0 ? 0 : band >= 1 ? CLAMPED_REFLECTANCE : band)) as Bands;
      if (material.reflectance.every((band, n) => band === given[n])) continue;
      this.warnings.push(`material '${material.name}': reflectance ${textOf(given)} is clamped to ${textOf(material.reflectance)}`);
    }
  }

  private newChunk(): GeometryChunk {
    const request = create(CreateSceneRequestSchema, { content: { case: "chunk", value: {} } });
    this.requests.push(request);
    this.chunks.push(request.content.value as GeometryChunk);
    return this.chunks.at(-1)!;
  }
}

const rgb = ([r, g, b]: Bands) => ({ $typeName: "alvor.v1.Rgb" as const, r, g, b });

/** Six digits, as C's %g. */
const textOf = (bands: Bands) => bands.map((band) => String(Number(band.toPrecision(6)))).join(" ");

/** A file's names may hold anything. */
const oneLine = (text: string) => text.replace(/[\x00-\x20\x7f]+/g, " ").trim().slice(0, LONGEST_WARNING);
