// Reads compact solution files, room.alvor: proto/alvor/v1/solution_file.proto.

import { fromBinary, type DescMessage, type MessageShape } from "@bufbuild/protobuf";
import { ReadImagesResponseSchema, ReadMeshResponseSchema, type ReadMeshResponse } from "./gen/alvor/v1/scene_service_pb";
import { SolutionPartSchema, type CompressedMessage, type SolutionPart } from "./gen/alvor/v1/solution_file_pb";
import type { LeafErrors, LeafValues } from "./gen/alvor/v1/solve_service_pb";
import { BadFrame, unpack } from "./mirror/leaves";
import { ImageCollector, type Image } from "./textures/image";

const MAGIC = [0x89, 0x41, 0x4c, 0x56, 0x4f, 0x52, 0x0d, 0x0a];
const NEWEST_VERSION = 2;
const MOST_RAW_BYTES = 16 << 20;

export interface SolutionFile {
  mesh: ReadMeshResponse[];
  leaves: LeafValues[];
  errors: LeafErrors[];
  images: Image[];
}

export const isSolutionFile = (file: File) => file.name.toLowerCase().endsWith(".alvor");

/** Throws BadFrame if the bytes are no solution file. */
export function readSolution(bytes: Uint8Array): SolutionFile {
  const file: SolutionFile = { mesh: [], leaves: [], errors: [], images: [] };
  const images = new ImageCollector();
  let isFirst = true;
  for (const { part } of partsOf(bytes)) {
    if (isFirst !== (part.case === "header")) throw new BadFrame("the header of the file is missing");
    isFirst = false;
    if (part.case === "header" && !(part.value.version >= 1 && part.value.version <= NEWEST_VERSION)) throw new BadFrame("a newer program wrote the file");
    if (part.case === "mesh") file.mesh.push(unpacked(ReadMeshResponseSchema, part.value));
    if (part.case === "images") images.take(unpacked(ReadImagesResponseSchema, part.value));
    if (part.case === "leaves") file.leaves.push(part.value);
    if (part.case === "errors") file.errors.push(part.value);
  }
  if (file.mesh.length === 0) throw new BadFrame("the file has no mesh");
  if (!images.isWhole) throw new BadFrame("an image of the file is not whole");
  return { ...file, images: images.images };
}

function* partsOf(bytes: Uint8Array): Generator<SolutionPart> {
  if (!MAGIC.every((byte, n) => bytes[n] === byte)) throw new BadFrame("this is no solution file of Alvor");
  for (let at = MAGIC.length; at < bytes.length; ) {
    let length = 0;
    for (let scale = 1; ; scale *= 128) {
      if (at >= bytes.length || scale > 2 ** 28) throw new BadFrame("the file is cut off");
      const byte = bytes[at++];
      length += (byte & 0x7f) * scale;
      if (byte < 0x80) break;
    }
    if (length > bytes.length - at) throw new BadFrame("the file is cut off");
    yield parsed(SolutionPartSchema, bytes.subarray(at, at + length));
    at += length;
  }
}

function unpacked<Desc extends DescMessage>(schema: Desc, { rawSize, zstd }: CompressedMessage): MessageShape<Desc> {
  if (rawSize > MOST_RAW_BYTES) throw new BadFrame("a part of the file claims to be larger than parts are");
  return parsed(schema, unpack(zstd, rawSize));
}

function parsed<Desc extends DescMessage>(schema: Desc, bytes: Uint8Array): MessageShape<Desc> {
  try {
    return fromBinary(schema, bytes);
  } catch {
    throw new BadFrame("a part of the file is no message");
  }
}
