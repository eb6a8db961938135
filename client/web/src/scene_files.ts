// Scene files that a person drops: OBJ with MTL, or GLB, read by three.js, as the API's scene. Conventions as in `alvor solve`: emission is
// radiance, exitance pi times that; what has no material reflects half.

import { create } from "@bufbuild/protobuf";
import { BufferGeometry, Color, ColorManagement, DoubleSide, Matrix4, Mesh, Vector3, type Material, type Object3D } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { MTLLoader } from "three/addons/loaders/MTLLoader.js";
import { OBJLoader } from "three/addons/loaders/OBJLoader.js";
import { CreateSceneRequestSchema, type CreateSceneRequest } from "./gen/alvor/v1/scene_service_pb";

// Numbers in files are what they are: no conversion from sRGB.
ColorManagement.enabled = false;

export class SceneFileError extends Error {}

/** As messages of CreateScene. Throws SceneFileError. */
export async function readSceneFiles(files: File[]): Promise<CreateSceneRequest[]> {
  const find = (extension: string) => files.find((file) => file.name.toLowerCase().endsWith(extension));
  const glb = find(".glb");
  const obj = find(".obj");
  const file = glb ?? obj;
  if (!file) throw new SceneFileError("No OBJ or GLB among these files");
  const root = glb ? await readGlb(glb) : await readObj(obj!, files);
  const scene = new SceneBuilder();
  root.updateMatrixWorld(true);
  root.traverse((object) => {
    if (object instanceof Mesh) scene.add(object);
  });
  return scene.messages(file.name);
}

async function readGlb(file: File): Promise<Object3D> {
  try {
    return (await new GLTFLoader().parseAsync(await file.arrayBuffer(), "")).scene;
  } catch (error) {
    throw new SceneFileError(`${file.name}: ${error instanceof Error ? error.message : "cannot be read"}`);
  }
}

async function readObj(obj: File, files: File[]): Promise<Object3D> {
  const loader = new OBJLoader();
  const library = files.filter((file) => file.name.toLowerCase().endsWith(".mtl"));
  const texts = await Promise.all(library.map((file) => file.text()));
  const materials = new MTLLoader().parse(withoutTextures(texts.join("\n")), "");
  materials.preload();
  loader.setMaterials(materials);
  const text = await obj.text();
  if (!/^\s*f\s/m.test(text)) throw new SceneFileError(`${obj.name}: has no faces`);
  const root = loader.parse(text);
  root.traverse((object) => {
    if (!(object instanceof Mesh)) return;
    for (const material of [object.material].flat() as (Material & { color?: Color })[])
      if (!(material.name in materials.materialsInfo)) material.color?.setRGB(0.5, 0.5, 0.5);
  });
  return root;
}

const withoutTextures = (mtl: string) => mtl.replace(/^\s*(map_|bump|disp|norm|refl).*$/gim, "");

const CHUNK_FACES = 20_000;

class SceneBuilder {
  private readonly chunks: CreateSceneRequest[] = [];
  private chunk = this.newChunk();
  private readonly materialIndex = new Map<string, number>();
  private vertices = 0;

  messages(name: string): CreateSceneRequest[] {
    const first = create(CreateSceneRequestSchema, {
      content: { case: "scene", value: { displayName: name } },
      requestId: crypto.randomUUID?.() ?? String(Math.random()),
    });
    return [first, ...this.chunks];
  }

  add(mesh: Mesh): void {
    const geometry = mesh.geometry;
    const position = geometry.getAttribute("position");
    if (!position) return;
    const first = this.vertices;
    const place = new Vector3();
    for (let n = 0; n < position.count; ++n) {
      place.fromBufferAttribute(position, n).applyMatrix4(mesh.matrixWorld);
      this.chunk.vertexCoordinates.push(place.x, place.y, place.z);
    }
    this.vertices += position.count;
    const materials = Array.isArray(mesh.material) ? mesh.material : [mesh.material];
    const mirrored = new Matrix4().copy(mesh.matrixWorld).determinant() < 0;
    for (const { start, count, materialIndex } of groupsOf(geometry)) {
      const material = this.indexOf(materials[materialIndex ?? 0]);
      for (const face of facesOf(geometry, start, count)) {
        if (mirrored) face.reverse();
        this.addFace(face.map((corner) => first + corner), material);
      }
    }
  }

  private addFace(corners: number[], material: number): void {
    if (this.chunk.faceCornerCounts.length === CHUNK_FACES) this.chunk = this.newChunk();
    this.chunk.faceCornerCounts.push(corners.length);
    this.chunk.faceMaterials.push(material);
    this.chunk.cornerVertices.push(...corners);
  }

  private newChunk() {
    const message = create(CreateSceneRequestSchema, { content: { case: "chunk", value: {} } });
    this.chunks.push(message);
    return message.content.value as Extract<CreateSceneRequest["content"], { case: "chunk" }>["value"];
  }

  private indexOf(material: Material): number {
    const known = this.materialIndex.get(material.uuid);
    if (known !== undefined) return known;
    const look = material as Material & { color?: Color; emissive?: Color; emissiveIntensity?: number };
    const radiance = (look.emissiveIntensity ?? 1) * Math.PI;
    const emission = look.emissive ?? new Color(0, 0, 0);
    const reflectance = look.color ?? new Color(0.5, 0.5, 0.5);
    this.chunk.materials.push({
      $typeName: "alvor.v1.Material",
      name: material.name,
      emission: rgb(emission, radiance),
      reflectance: rgb(reflectance, 1),
      twoSided: material.side === DoubleSide,
    });
    this.materialIndex.set(material.uuid, this.materialIndex.size);
    return this.materialIndex.size - 1;
  }
}

const rgb = ({ r, g, b }: Color, by: number) => ({ $typeName: "alvor.v1.Rgb" as const, r: r * by, g: g * by, b: b * by });

function groupsOf(geometry: BufferGeometry): { start: number; count: number; materialIndex?: number }[] {
  const count = geometry.index?.count ?? geometry.getAttribute("position").count;
  return geometry.groups.length > 0 ? geometry.groups : [{ start: 0, count, materialIndex: 0 }];
}

/** Triangles, but two that are a convex quad cut along a diagonal, as OBJLoader leaves it, are the quad again. */
function facesOf(geometry: BufferGeometry, start: number, count: number): number[][] {
  const index = (n: number) => geometry.index?.getX(n) ?? n;
  const faces: number[][] = [];
  for (let n = start; n + 2 < start + count; n += 3) {
    const triangle = [index(n), index(n + 1), index(n + 2)];
    const before = faces.at(-1);
    const quad = before?.length === 3 ? quadOf(geometry, before, triangle) : undefined;
    if (quad) faces[faces.length - 1] = quad;
    else faces.push(triangle);
  }
  return faces;
}

function quadOf(geometry: BufferGeometry, [a, b, c]: number[], [d, e, f]: number[]): number[] | undefined {
  const at = (n: number) => new Vector3().fromBufferAttribute(geometry.getAttribute("position"), n);
  if (!at(a).equals(at(d)) || !at(c).equals(at(e))) return undefined;
  const corners = [a, b, c, f].map(at);
  const normals = corners.map((corner, n) =>
    corners[(n + 1) % 4].clone().sub(corner).cross(corners[(n + 2) % 4].clone().sub(corners[(n + 1) % 4])).normalize(),
  );
  // Hardly bent ones too: the server cuts what is not planar.
  return normals.every((normal) => normal.dot(normals[0]) > 0.99) ? [a, b, c, f] : undefined;
}
