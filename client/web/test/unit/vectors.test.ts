import { readFileSync } from "node:fs";
import { fromBinary, type DescMessage, type MessageShape } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { ReadMeshResponseSchema } from "../../src/gen/alvor/v1/scene_service_pb";
import { WatchSolveResponseSchema } from "../../src/gen/alvor/v1/solve_service_pb";
import { BaseMesh } from "../../src/mirror/base_mesh";
import { withAdded } from "../../src/mirror/copies";
import { decodeErrors } from "../../src/mirror/errors";
import { BadFrame, decodeLeaves } from "../../src/mirror/leaves";
import { GRID, Mirror } from "../../src/mirror/mirror";

const VECTORS = new URL("../../../../tests/vectors/", import.meta.url);

function messagesOf<Schema extends DescMessage>(schema: Schema, file: string): MessageShape<Schema>[] {
  const bytes = readFileSync(new URL(file, VECTORS));
  const messages: MessageShape<Schema>[] = [];
  for (let at = 0; at < bytes.length; ) {
    const length = bytes.readUInt32LE(at);
    messages.push(fromBinary(schema, bytes.subarray(at + 4, at + 4 + length)));
    at += 4 + length;
  }
  return messages;
}

const framesOf = (name: string) => messagesOf(WatchSolveResponseSchema, `${name}.frames`);

/** What is drawn of each root patch of a mesh: its corners, how it is joined to others, and its material; null if it is hidden. */
function rootsOf(mesh: BaseMesh) {
  const rounded = (x: number) => Math.round(1e9 * x) / 1e9 + 0; // no -0
  return Array.from({ length: mesh.rootCount }, (_, root) => {
    if (mesh.isHidden(root)) return null;
    const [first, end] = [mesh.firstCorner[root], mesh.firstCorner[root + 1]];
    const corners = Array.from(mesh.corners.subarray(3 * first, 3 * end), (x, n) => rounded(x + mesh.centre[n % 3]));
    const { emission, reflectance, diffuseTransmittance } = mesh.materials[mesh.material[root]];
    const joined = [mesh.placeKey(root, 0, 0), mesh.placeKey(root, GRID / 2, 0), mesh.placeKey(root, 0, GRID / 2)];
    return { corners, joined, faces: mesh.sceneFacesOf(root), emission, reflectance, diffuseTransmittance };
  });
}

function bytesOf(mirror: Mirror): Buffer {
  const parts: Buffer[] = [];
  for (const leaf of mirror.leaves()) {
    const part = Buffer.alloc(20);
    part.writeUInt32LE(leaf.path, 0);
    part.writeUInt32LE(leaf.slabs * 2 ** 22 + leaf.face, 4);
    leaf.rgb.forEach((x, band) => part.writeFloatLE(x, 8 + 4 * band));
    parts.push(part);
  }
  return Buffer.concat(parts);
}

describe("the mirror", () => {
  it.each(["display", "exact", "deep", "one_page", "uneven", "errors", "merges", "slabs", "edits"])("holds what the C++ mirror holds after the frames of %s", (name) => {
    const mirror = new Mirror(2000);
    const frames = framesOf(name);
    expect(frames.length).toBeGreaterThan(0);
    for (const frame of frames) {
      mirror.apply(decodeLeaves(frame.leaves!));
      if (frame.stateHash !== undefined) expect(mirror.stateHash).toBe(frame.stateHash);
      if (frame.errors) mirror.takeErrors(decodeErrors(frame.errors));
    }
    expect(bytesOf(mirror).equals(readFileSync(new URL(`${name}.leaves`, VECTORS)))).toBe(true);
    expect(mirror.hasErrors).toBe(name === "errors");
    if (name !== "errors") return;
    const expected = readFileSync(new URL("errors.errors", VECTORS));
    const told = Array.from({ length: 2000 }, (_, root) => [...mirror.leavesUnder(root)]).flat();
    expect(told.length).toBeGreaterThan(expected.length / 4); // roots of which nothing was said are leaves here
    for (let n = 0; n < expected.length / 4; ++n) {
      const error = expected.readFloatLE(4 * n);
      expect(Math.abs(mirror.errors[told[n]] - error)).toBeLessThanOrEqual(1e-6 * error);
    }
  });

  it("shows edits as the server has them, whether it saw all of them or the last look alone", () => {
    const submitted = messagesOf(ReadMeshResponseSchema, "edits.submitted");
    const looks = framesOf("edits").flatMap(({ look }) => look ?? []);
    expect(looks.map(({ edits }) => Number(edits))).toEqual([1, 2, 3, 4, 5, 6, 7, 8]);
    const withAll = withAdded(submitted, looks.at(-1)!);
    const expected = rootsOf(new BaseMesh(messagesOf(ReadMeshResponseSchema, "edits.edited")));
    for (const applied of [looks, looks.slice(-1)]) {
      const mesh = new BaseMesh(withAll, submitted.length);
      for (const look of applied) mesh.applyLook(look);
      expect(rootsOf(mesh)).toEqual(expected);
    }
    expect(expected.some((root) => root === null)).toBe(true);
    expect(expected.length).toBeGreaterThan(new BaseMesh(submitted).rootCount);
  });

  it("refuses errors of leaves that are not there, and pages that claim too much", () => {
    const { errors } = framesOf("errors").find((frame) => frame.errors)!;
    expect(() => new Mirror(2000).takeErrors(decodeErrors(errors!))).toThrow(BadFrame);
    expect(() => decodeErrors({ ...errors!, count: 2 ** 31 })).toThrow(BadFrame);
    expect(() => decodeErrors({ ...errors!, zstd: errors!.zstd.subarray(0, 10) })).toThrow(BadFrame);
    expect(() => decodeErrors({ ...errors!, scale: 1e9 })).toThrow(BadFrame);
  });

  it("applies a frame whole or not at all", () => {
    const frames = framesOf("exact");
    const mirror = new Mirror(29); // the frames speak of 30
    const before = bytesOf(mirror);
    expect(() => mirror.apply(decodeLeaves(frames[0].leaves!))).toThrow(BadFrame);
    expect(bytesOf(mirror).equals(before)).toBe(true);
  });

  it("refuses slabs of a triangle", () => {
    const ofQuads = new Mirror(2000, undefined, () => false);
    const ofTriangles = new Mirror(2000, undefined, () => true);
    const withSlabs = framesOf("slabs").map(({ leaves }) => decodeLeaves(leaves!));
    expect(() => withSlabs.forEach((leaves) => ofQuads.apply(leaves))).not.toThrow();
    expect(() => withSlabs.forEach((leaves) => ofTriangles.apply(leaves))).toThrow(/is a triangle, and has slabs/);
  });

  it("refuses frames that are cut off, or claim too much", () => {
    const leaves = framesOf("display")[0].leaves!;
    expect(() => decodeLeaves({ ...leaves, zstd: leaves.zstd.subarray(0, 20) })).toThrow(BadFrame);
    expect(() => decodeLeaves({ ...leaves, rawSize: leaves.rawSize + 1 })).toThrow(BadFrame);
    expect(() => decodeLeaves({ ...leaves, count: 60_000 })).toThrow(BadFrame);
    expect(() => decodeLeaves({ ...leaves, rawSize: 2 ** 31 })).toThrow(BadFrame);
  });
});
