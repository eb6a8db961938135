// The default scene of a glTF 2.0 file, as import/gltf_import.cpp and import/gltf_material.cpp read it.

import type { DroppedFiles } from "./dropped_files";
import { GltfFile } from "./gltf_file";
import type { Gltf, GltfMaterial, GltfNode, GltfPrimitive, GltfTexture } from "./gltf_format";
import { ImportError } from "./import_error";
import { IDENTITY, mirrors, placementOf, point, product, type Placement } from "./placement";
import { SceneBuilder } from "./scene_builder";
import { isZero, meanColour, textured, type Bands } from "./texture_colour";
import { Unsupported, type UnsupportedKind } from "./unsupported";

/** Throws ImportError, and MissingParts. */
export async function readGltf(files: DroppedFiles): Promise<SceneBuilder> {
  return new GltfReader(await GltfFile.read(files)).read();
}

const TRIANGLES = 4;
const STRIP = 5;
const FAN = 6;

interface Vertices {
  first: number;
  count: number;
}

interface Pending {
  node: number;
  parent: Placement;
}

class GltfReader {
  private readonly json: Gltf;
  private readonly scene = new SceneBuilder();
  private readonly unsupported = new Unsupported();
  private readonly seen = new Set<number>();
  private defaultMaterial?: number;

  constructor(private readonly file: GltfFile) {
    this.json = file.json;
  }

  async read(): Promise<SceneBuilder> {
    for (const material of this.json.materials ?? []) await this.addMaterial(material);
    this.addTree(this.rootNodes());
    this.countUnsupportedMaterials();
    this.unsupported.appendWarnings(this.scene.warnings);
    return this.scene;
  }

  private async addMaterial(source: GltfMaterial): Promise<void> {
    const name = source.name || String(this.scene.materials.length);
    const surface = source.pbrMetallicRoughness ?? {};
    const strength = source.extensions?.KHR_materials_emissive_strength?.emissiveStrength ?? 1;
    const light = bandsOf(source.emissiveFactor ?? [0, 0, 0]).map((band) => strength * band) as Bands;
    const reflectance = await this.underTexture(bandsOf(surface.baseColorFactor ?? [1, 1, 1]), surface.baseColorTexture, name);
    const radiance = await this.underTexture(light, source.emissiveTexture, name);
    this.scene.addMaterial({ name, radiance, reflectance, twoSided: source.doubleSided === true });
  }

  private async underTexture(factor: Bands, texture: GltfTexture | undefined, material: string): Promise<Bands> {
    if (texture?.index === undefined || isZero(factor)) return factor;
    const index = this.json.textures?.[texture.index]?.source;
    const image = index === undefined ? undefined : this.json.images?.[index];
    const uri = image?.uri?.startsWith("data:") ? undefined : image?.uri;
    const encoded = index === undefined || !image ? undefined : this.file.image(index);
    const name = `material '${material}': texture '${image?.name || uri || texture.index}'`;
    return textured(factor, encoded && (await meanColour(encoded)), name, this.scene.warnings);
  }

  private rootNodes(): number[] {
    const { scenes = [], nodes = [] } = this.json;
    if (scenes.length > 0) return element(scenes, this.json.scene ?? 0, "scene", "file").nodes ?? [];
    // A file without scenes is a library of nodes: show those that hang from no other.
    const hanging = new Set(nodes.flatMap(({ children = [] }) => children));
    return nodes.map((_, n) => n).filter((n) => !hanging.has(n));
  }

  /** Depth first, without recursion: the depth is the file's choice. */
  private addTree(roots: number[]): void {
    const stack: Pending[] = [];
    const push = (nodes: number[], parent: Placement) => {
      for (let n = nodes.length - 1; n >= 0; --n) stack.push({ node: nodes[n], parent });
    };
    push(roots, IDENTITY);
    for (let next = stack.pop(); next; next = stack.pop()) {
      const { node, placement } = this.enter(next);
      if (node.mesh !== undefined) this.addMesh(node.mesh, placement);
      this.countLight(node);
      push(node.children ?? [], placement);
    }
  }

  /** A node met twice would be its own ancestor, or shared: glTF allows neither, and it could go on for ever. */
  private enter({ node: index, parent }: Pending): { node: GltfNode; placement: Placement } {
    const node = element(this.json.nodes, index, "node", "scene");
    if (this.seen.has(index)) throw new ImportError(`node ${index}`, "hangs from more than one node");
    this.seen.add(index);
    return { node, placement: product(parent, placementOf(node, `node ${index}`)) };
  }

  private addMesh(index: number, placement: Placement): void {
    const { primitives = [] } = element(this.json.meshes, index, "mesh", "scene");
    const shared = new Map<number, Vertices>(); // primitives often share their vertices
    primitives.forEach((primitive, n) => {
      const mode = primitive.mode ?? TRIANGLES;
      if (mode < 0 || mode >= TRIANGLES) this.addPrimitive(primitive, mode, `mesh ${index} primitive ${n}`, placement, shared);
    });
  }

  private addPrimitive(primitive: GltfPrimitive, mode: number, place: string, placement: Placement, shared: Map<number, Vertices>): void {
    const position = primitive.attributes?.POSITION;
    if (position === undefined) throw new ImportError(place, "has no POSITION");
    const { first, count } = this.addVertices(position, placement, shared);
    const material = this.materialOf(primitive, place);
    const indices = primitive.indices === undefined ? Float64Array.from({ length: count }, (_, n) => n) : this.file.indices(primitive.indices);
    const isTurned = mirrors(placement);
    for (const [a, b, c] of trianglesOf(mode, indices, place)) {
      for (const vertex of [a, b, c])
        if (vertex >= count) throw new ImportError(place, `vertex index ${vertex} is out of range, there are ${count} vertices`);
      this.scene.addFace(isTurned ? [first + a, first + c, first + b] : [first + a, first + b, first + c], material);
    }
  }

  private addVertices(accessor: number, placement: Placement, shared: Map<number, Vertices>): Vertices {
    const known = shared.get(accessor);
    if (known) return known;
    const positions = this.file.positions(accessor);
    const added = { first: this.scene.vertexCount, count: positions.length / 3 };
    for (let n = 0; n < positions.length; n += 3)
      this.scene.addVertex(...point(placement, [positions[n], positions[n + 1], positions[n + 2]]));
    shared.set(accessor, added);
    return added;
  }

  private materialOf({ material }: GltfPrimitive, place: string): number {
    if (material === undefined) return (this.defaultMaterial ??= this.scene.addDefaultMaterial());
    element(this.json.materials, material, "material", place);
    return material;
  }

  private countLight({ extensions }: GltfNode): void {
    const light = extensions?.KHR_lights_punctual;
    if (!light) return;
    const { type } = element(this.json.extensions?.KHR_lights_punctual?.lights, light.light ?? -1, "light", "scene");
    const kinds: Record<string, UnsupportedKind> = { point: "pointLights", spot: "spotLights", directional: "directionalLights" };
    this.unsupported.add(kinds[type ?? ""] ?? "otherLights");
  }

  private countUnsupportedMaterials(): void {
    const used = this.scene.usedMaterials();
    (this.json.materials ?? []).forEach(({ pbrMetallicRoughness: surface = {}, alphaMode = "OPAQUE", extensions = {} }, n) => {
      if (!used[n]) return;
      // Under a texture the factor is the default, 1, for what is not metal too.
      const isMetal = (surface.metallicFactor ?? 1) > 0.5 && surface.metallicRoughnessTexture === undefined;
      this.unsupported.add("transparentMaterials", alphaMode !== "OPAQUE");
      this.unsupported.add("metals", isMetal);
      const isTransmissive = "KHR_materials_transmission" in extensions || "KHR_materials_diffuse_transmission" in extensions;
      this.unsupported.add("transmissiveMaterials", isTransmissive);
    });
  }
}

function element<T>(list: T[] | undefined, index: number, kind: string, user: string): T {
  const found = list?.[index];
  if (found === undefined) throw new ImportError(user, `${kind} ${index} is not in the file`);
  return found;
}

const bandsOf = (factor: number[]): Bands => (factor.length < 3 ? [0, 0, 0] : [factor[0], factor[1], factor[2]]);

type Triangle = [number, number, number];

function* trianglesOf(mode: number, indices: Float64Array, place: string): Generator<Triangle> {
  if (mode === TRIANGLES && indices.length % 3 !== 0) throw new ImportError(place, `${indices.length} indices are not whole triangles`);
  if (mode > FAN || mode < 0) throw new ImportError(place, `mode ${mode} is unknown`);
  for (let n = 2; n < indices.length; n += mode === TRIANGLES ? 3 : 1) {
    const [a, b, c] = [indices[n - 2], indices[n - 1], indices[n]];
    if (mode === FAN) yield [b, c, indices[0]];
    // Strips are stitched together by triangles that name a vertex twice; these are no faces.
    else if (mode === STRIP && (a === b || b === c || c === a)) continue;
    else yield mode === STRIP && n % 2 === 1 ? [a, c, b] : [a, b, c];
  }
}
