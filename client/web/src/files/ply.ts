// PLY, text or binary: vertices and faces. It has no materials; its axes are z up, as in client/assimp_import.cpp.

import { UpAxis } from "../gen/alvor/v1/scene_service_pb";
import { ImportError } from "./import_error";
import { isFiniteNumber } from "./lines";
import { SceneBuilder } from "./scene_builder";

export async function readPly(file: File): Promise<SceneBuilder> {
  const bytes = await file.arrayBuffer();
  const { elements, format, end } = headerOf(new Uint8Array(bytes));
  const values: Values = format === "ascii" ? new TextValues(bytes.slice(end)) : new BinaryValues(bytes, end, format === "binary_little_endian");
  const scene = new SceneBuilder();
  scene.up = UpAxis.Z;
  const material = scene.addDefaultMaterial();
  scene.materials[material].twoSided = true; // scans are open: Assimp, through which `alvor` reads PLY, takes it so too
  for (const element of elements) {
    if (element.count > bytes.byteLength)
      throw new ImportError(`element ${element.name}`, `the file is too short for ${element.count} of them`);
    for (let n = 0; n < element.count; ++n) readElement(element, n, values, scene, material);
  }
  scene.refuseVerticesBeyond(0);
  return scene;
}

interface Property {
  name: string;
  type: string;
  /** Type of a list's length; none for a single value. */
  countType?: string;
}

interface Element {
  name: string;
  count: number;
  properties: Property[];
}

function headerOf(bytes: Uint8Array): { elements: Element[]; format: string; end: number } {
  const text = new TextDecoder("latin1").decode(bytes.subarray(0, 65536));
  if (!/^ply\r?\n/.test(text)) throw new ImportError("file", "does not begin with 'ply'");
  const last = /^end_header\r?\n/m.exec(text);
  if (!last) throw new ImportError("file", "its header has no end_header");
  const elements: Element[] = [];
  let format = "";
  for (const line of text.slice(0, last.index).split(/\r?\n/)) {
    const [keyword, ...words] = line.trim().split(/\s+/);
    if (keyword === "format") format = words[0];
    if (keyword === "element") elements.push({ name: words[0], count: Number(words[1]), properties: [] });
    if (keyword !== "property") continue;
    const isList = words[0] === "list";
    elements.at(-1)?.properties.push(isList ? { countType: words[1], type: words[2], name: words[3] } : { type: words[0], name: words[1] });
  }
  if (!["ascii", "binary_little_endian", "binary_big_endian"].includes(format)) throw new ImportError("file", `its format '${format}' is unknown`);
  return { elements, format, end: last.index + last[0].length };
}

function readElement({ name, properties }: Element, n: number, values: Values, scene: SceneBuilder, material: number): void {
  const place = `${name} ${n}`;
  const numbers: Record<string, number> = {};
  let corners: number[] = [];
  for (const property of properties) {
    if (property.countType === undefined) {
      numbers[property.name] = values.next(property.type, place);
      continue;
    }
    const list = [];
    for (let left = values.next(property.countType, place); left > 0; --left) list.push(values.next(property.type, place));
    if (property.name === "vertex_indices" || property.name === "vertex_index") corners = list;
  }
  if (name === "vertex") addVertex(numbers, place, scene);
  if (name === "face" && corners.length >= 3) addFace(corners, place, scene, material);
}

function addVertex({ x, y, z }: Record<string, number>, place: string, scene: SceneBuilder): void {
  if (x === undefined || y === undefined || z === undefined) throw new ImportError("element vertex", "has no x, y and z");
  if (![x, y, z].every(Number.isFinite)) throw new ImportError(place, "its coordinates are not finite numbers");
  scene.addVertex(x, y, z);
}

function addFace(corners: number[], place: string, scene: SceneBuilder, material: number): void {
  const bad = corners.find((vertex) => !(vertex >= 0));
  if (bad !== undefined) throw new ImportError(place, `vertex index ${bad} is out of range`);
  scene.addFace(corners, material);
}

/** Yields the body's values one after the other. `place` names what ends too early. */
interface Values {
  next(type: string, place: string): number;
}

const READERS: Record<string, [number, (view: DataView, at: number, little: boolean) => number]> = {
  char: [1, (view, at) => view.getInt8(at)],
  uchar: [1, (view, at) => view.getUint8(at)],
  short: [2, (view, at, little) => view.getInt16(at, little)],
  ushort: [2, (view, at, little) => view.getUint16(at, little)],
  int: [4, (view, at, little) => view.getInt32(at, little)],
  uint: [4, (view, at, little) => view.getUint32(at, little)],
  float: [4, (view, at, little) => view.getFloat32(at, little)],
  double: [8, (view, at, little) => view.getFloat64(at, little)],
};
const ALIASES: Record<string, string> = {
  int8: "char", uint8: "uchar", int16: "short", uint16: "ushort", int32: "int", uint32: "uint", float32: "float", float64: "double",
};

class BinaryValues implements Values {
  private readonly view: DataView;

  constructor(
    bytes: ArrayBuffer,
    private at: number,
    private readonly isLittle: boolean,
  ) {
    this.view = new DataView(bytes);
  }

  next(type: string, place: string): number {
    const reader = READERS[ALIASES[type] ?? type];
    if (!reader) throw new ImportError(place, `its type '${type}' is unknown`);
    const [size, read] = reader;
    if (this.at + size > this.view.byteLength) throw new ImportError("file", `ends within ${place}`);
    this.at += size;
    return read(this.view, this.at - size, this.isLittle);
  }
}

class TextValues implements Values {
  private readonly words: string[];
  private at = 0;

  constructor(bytes: ArrayBuffer) {
    this.words = new TextDecoder().decode(bytes).split(/\s+/).filter((word) => word !== "");
  }

  next(_type: string, place: string): number {
    if (this.at >= this.words.length) throw new ImportError("file", `ends within ${place}`);
    const word = this.words[this.at++];
    if (!isFiniteNumber(word)) throw new ImportError(place, `'${word.slice(0, 40)}' is not a finite number`);
    return Number(word);
  }
}
