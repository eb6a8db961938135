// A glTF 2.0 file, text or binary, and the bytes of its parts, as import/gltf_file.cpp and import/gltf_accessor.cpp read them.

import { percentDecoded, type DroppedFiles } from "./dropped_files";
import type { Gltf, GltfAccessor } from "./gltf_format";
import { ImportError } from "./import_error";

export type Bytes = Uint8Array<ArrayBuffer>;

const FILE_HEADER = 12;
const CHUNK_HEADER = 8;
const JSON_CHUNK = 0x4e4f534a;
const BINARY_CHUNK = 0x004e4942;
const GLTF = [0x67, 0x6c, 0x54, 0x46];

/** Names of parts that were not dropped. */
export class MissingParts extends Error {
  constructor(readonly names: string[]) {
    super(names.join(", "));
  }
}

export class GltfFile {
  private constructor(
    readonly json: Gltf,
    private readonly buffers: Bytes[],
    /** Encoded; undefined for those of buffer views. */
    private readonly images: (Bytes | undefined)[],
  ) {}

  /** Throws ImportError, and MissingParts. */
  static async read(files: DroppedFiles): Promise<GltfFile> {
    const { text, binary } = containerOf(new Uint8Array(await files.scene.arrayBuffer()));
    const json = parse(text);
    const parts = new Parts(files);
    const buffers: (Bytes | undefined)[] = [];
    for (const [n, { uri, byteLength }] of (json.buffers ?? []).entries()) {
      const place = `buffer ${n}${uri && !isDataUri(uri) ? ` '${uri}'` : ""}`;
      const bytes = uri ? await parts.read(uri, `buffer ${n}`) : n === 0 ? binary : undefined;
      if (!uri && !bytes) throw new ImportError(place, "names no file");
      buffers.push(bytes && cutToLength(bytes, byteLength, place));
    }
    const images: (Bytes | undefined)[] = [];
    const colours = colourImages(json);
    for (const [n, { uri, bufferView }] of (json.images ?? []).entries())
      images.push(uri && bufferView === undefined && colours.has(n) ? await parts.read(uri, `image ${n}`) : undefined);
    if (parts.missing.length > 0) throw new MissingParts(parts.missing);
    refuseUnknownExtensions(json);
    return new GltfFile(json, buffers as Bytes[], images);
  }

  /** Returns an image's encoded bytes. */
  image(index: number): Bytes | undefined {
    const view = this.json.images?.[index]?.bufferView;
    return view === undefined ? this.images[index] : this.view(view);
  }

  /** Returns x, y, z of each element. */
  positions(accessor: number): Float64Array {
    const { source, elements, place } = this.elementsOf(accessor, "VEC3");
    const load = loaderOf(COORDINATES, source, `${place}: positions`);
    const largest = source.normalized ? LARGEST[source.componentType!] : undefined;
    return this.load(elements, 3, (at) => (largest ? Math.max(load(elements.view, at) / largest, -1) : load(elements.view, at)));
  }

  indices(accessor: number): Float64Array {
    const { source, elements, place } = this.elementsOf(accessor, "SCALAR");
    const load = loaderOf(INDICES, source, `${place}: indices`);
    return this.load(elements, 1, (at) => load(elements.view, at));
  }

  private load({ count, stride, size }: Elements, width: number, value: (at: number) => number): Float64Array {
    const values = new Float64Array(width * count);
    for (let n = 0; n < count; ++n) for (let k = 0; k < width; ++k) values[width * n + k] = value(n * stride + k * size);
    return values;
  }

  private elementsOf(index: number, type: "SCALAR" | "VEC3") {
    const place = `accessor ${index}`;
    const source = this.json.accessors?.[index];
    if (!source) throw new ImportError(place, "is not in the file");
    if (source.sparse) throw new ImportError(place, "sparse accessors are not supported");
    if (source.type !== type) throw new ImportError(place, "is not of the type its use asks for");
    if (source.bufferView === undefined) throw new ImportError(place, "has no bufferView");
    const bytes = this.view(source.bufferView);
    const size = SIZES[source.componentType ?? 0] ?? 0;
    const whole = size * (type === "VEC3" ? 3 : 1);
    const stride = this.json.bufferViews![source.bufferView].byteStride || whole;
    const offset = source.byteOffset ?? 0;
    const count = source.count ?? 0;
    if (size === 0 || !(stride >= whole)) throw new ImportError(place, "its byteStride does not fit its elements");
    if (!isCount(offset) || offset > bytes.length) throw new ImportError(place, "begins beyond its bufferView");
    if (!isCount(count) || (count > 0 && (count - 1) * stride + whole > bytes.length - offset))
      throw new ImportError(place, "ends beyond its bufferView");
    const view = new DataView(bytes.buffer, bytes.byteOffset + offset, bytes.length - offset);
    return { source, place, elements: { view, count, stride, size } };
  }

  private view(index: number): Bytes {
    const place = `bufferView ${index}`;
    const range = this.json.bufferViews?.[index];
    if (!range) throw new ImportError(place, "is not in the file");
    const buffer = this.buffers[range.buffer ?? -1];
    if (!buffer) throw new ImportError(place, `buffer ${range.buffer ?? -1} is not in the file`);
    const offset = range.byteOffset ?? 0;
    const length = range.byteLength ?? 0;
    if (!isCount(offset) || !isCount(length) || offset + length > buffer.length)
      throw new ImportError(place, `ends beyond buffer ${range.buffer} of ${buffer.length} bytes`);
    return buffer.subarray(offset, offset + length);
  }
}

interface Elements {
  view: DataView;
  count: number;
  stride: number;
  size: number;
}

type Loader = (view: DataView, at: number) => number;

const SIZES: Record<number, number> = { 5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4 };
const LARGEST: Record<number, number> = { 5120: 127, 5121: 255, 5122: 32767, 5123: 65535 };
const INDICES: Record<number, Loader> = {
  5121: (view, at) => view.getUint8(at),
  5123: (view, at) => view.getUint16(at, true),
  5125: (view, at) => view.getUint32(at, true),
};
// Integers are coordinates under KHR_mesh_quantization.
const COORDINATES: Record<number, Loader> = {
  5120: (view, at) => view.getInt8(at),
  5121: (view, at) => view.getUint8(at),
  5122: (view, at) => view.getInt16(at, true),
  5123: (view, at) => view.getUint16(at, true),
  5126: (view, at) => view.getFloat32(at, true),
};

function loaderOf(loaders: Record<number, Loader>, { componentType }: GltfAccessor, what: string): Loader {
  const loader = loaders[componentType ?? 0];
  if (!loader) throw new ImportError("file", `${what} cannot have componentType ${componentType}`);
  return loader;
}

const isCount = (value: unknown) => Number.isInteger(value) && (value as number) >= 0;

/** The images that materials take a colour from. Others, of bumps or shine, may be missing. */
function colourImages({ materials = [], textures = [] }: Gltf): Set<number | undefined> {
  const used = materials.flatMap((material) => [material.pbrMetallicRoughness?.baseColorTexture?.index, material.emissiveTexture?.index]);
  return new Set(used.map((texture) => (texture === undefined ? undefined : textures[texture]?.source)));
}

/** Extensions that change neither shape nor place nor reflectance, and so may be required of a reader. */
const isHarmless = (name: string) =>
  (/^(KHR_materials_|KHR_texture_|EXT_texture_)/.test(name) && name !== "KHR_materials_pbrSpecularGlossiness") ||
  name === "KHR_mesh_quantization" ||
  name === "KHR_lights_punctual";

function refuseUnknownExtensions({ extensionsRequired = [] }: Gltf): void {
  for (const name of extensionsRequired)
    if (!isHarmless(name)) throw new ImportError("file", `requires the extension ${name}, which is not supported`);
}

function containerOf(file: Bytes): { text: Bytes; binary?: Bytes } {
  if (!GLTF.every((byte, n) => file[n] === byte)) return { text: file };
  if (file.length < FILE_HEADER) throw new ImportError("file", "ends within its header");
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  const version = view.getUint32(4, true);
  if (version !== 2) throw new ImportError("file", `is GLB of version ${version}, only 2 is supported`);
  const take = (at: number, type: number, name: string) => {
    if (file.length < at + CHUNK_HEADER || view.getUint32(at + 4, true) !== type) throw new ImportError("file", `has no ${name} chunk`);
    const end = at + CHUNK_HEADER + view.getUint32(at, true);
    if (end > file.length) throw new ImportError("file", `ends within its ${name} chunk`);
    return file.subarray(at + CHUNK_HEADER, end);
  };
  const text = take(FILE_HEADER, JSON_CHUNK, "JSON");
  const next = FILE_HEADER + CHUNK_HEADER + text.length;
  return { text, binary: next < file.length ? take(next, BINARY_CHUNK, "BIN") : undefined };
}

function parse(text: Bytes): Gltf {
  let json: Gltf;
  try {
    json = JSON.parse(new TextDecoder().decode(text));
  } catch (error) {
    const at = /position (\d+)/.exec(String(error))?.[1];
    throw new ImportError("file", `its JSON is broken${at ? ` at character ${at}` : ""}`);
  }
  if (typeof json !== "object" || json === null || typeof json.asset !== "object") throw new ImportError("file", "is not glTF: it has no asset");
  const version = String(json.asset?.version ?? "");
  if (!version.startsWith("2.")) throw new ImportError("file", `is glTF of version ${version || "unknown"}, only 2 is supported`);
  return json;
}

const isDataUri = (uri: string) => uri.startsWith("data:");

/** Reads what URIs stand for, and keeps the names of what is not there. */
class Parts {
  readonly missing: string[] = [];

  constructor(private readonly files: DroppedFiles) {}

  async read(uri: string, place: string): Promise<Bytes | undefined> {
    if (isDataUri(uri)) return decoded(uri, place);
    const name = this.files.nameOf(uri, place);
    const file = this.files.find(name);
    if (file) return new Uint8Array(await file.arrayBuffer());
    if (!this.missing.includes(name)) this.missing.push(name);
    return undefined;
  }
}

function decoded(uri: string, place: string): Bytes {
  const comma = uri.indexOf(",");
  const content = uri.slice(comma + 1);
  try {
    if (comma < 0) throw new Error("no content");
    return uri.slice(0, comma).endsWith(";base64") ? Uint8Array.from(atob(content), (c) => c.charCodeAt(0)) : percentDecoded(content);
  } catch {
    throw new ImportError(place, "its data URI is broken");
  }
}

/** A buffer may be shorter than what holds it, not longer. */
function cutToLength(bytes: Bytes, length: number | undefined, place: string): Bytes {
  if (!isCount(length)) throw new ImportError(place, "has no byteLength");
  if (length! > bytes.length) throw new ImportError(place, `is too short: ${bytes.length} of ${length} bytes`);
  return bytes.subarray(0, length);
}
