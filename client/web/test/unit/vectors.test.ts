import { readFileSync } from "node:fs";
import { fromBinary } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { WatchSolveResponseSchema, type WatchSolveResponse } from "../../src/gen/alvor/v1/solve_service_pb";
import { decodeErrors } from "../../src/mirror/errors";
import { BadFrame, decodeLeaves } from "../../src/mirror/leaves";
import { Mirror } from "../../src/mirror/mirror";

const VECTORS = new URL("../../../../tests/vectors/", import.meta.url);

function framesOf(name: string): WatchSolveResponse[] {
  const bytes = readFileSync(new URL(`${name}.frames`, VECTORS));
  const frames: WatchSolveResponse[] = [];
  for (let at = 0; at < bytes.length; ) {
    const length = bytes.readUInt32LE(at);
    frames.push(fromBinary(WatchSolveResponseSchema, bytes.subarray(at + 4, at + 4 + length)));
    at += 4 + length;
  }
  return frames;
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
  it.each(["display", "exact", "deep", "one_page", "uneven", "errors", "merges", "slabs"])("holds what the C++ mirror holds after the frames of %s", (name) => {
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

  it("refuses frames that are cut off, or claim too much", () => {
    const leaves = framesOf("display")[0].leaves!;
    expect(() => decodeLeaves({ ...leaves, zstd: leaves.zstd.subarray(0, 20) })).toThrow(BadFrame);
    expect(() => decodeLeaves({ ...leaves, rawSize: leaves.rawSize + 1 })).toThrow(BadFrame);
    expect(() => decodeLeaves({ ...leaves, count: 60_000 })).toThrow(BadFrame);
    expect(() => decodeLeaves({ ...leaves, rawSize: 2 ** 31 })).toThrow(BadFrame);
  });
});
