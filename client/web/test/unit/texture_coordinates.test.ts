import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { ReadMeshResponseSchema } from "../../src/gen/alvor/v1/scene_service_pb";
import { BaseMesh } from "../../src/mirror/base_mesh";
import { GRID, Mirror } from "../../src/mirror/mirror";
import { SLOT_VERTICES, Surface } from "../../src/mirror/surface";

const grey = { name: "grey", emission: { r: 0, g: 0, b: 0 }, reflectance: { r: 0.5, g: 0.5, b: 0.5 } };

/** One root of these corners, far from the origin, whose coordinates come in two messages. */
function meshOf(corners: [number, number, number][], coordinates: number[]): BaseMesh {
  return new BaseMesh([
    create(ReadMeshResponseSchema, {
      cornerCounts: [corners.length],
      materials: [0],
      sceneFaces: [0],
      cornerCoordinates: corners.flatMap(([x, y, z]) => [x + 1000, y, z]),
      neighbours: corners.map(() => 0n),
      sceneMaterials: [grey],
      textureCoordinates: coordinates.slice(0, 3),
    }),
    create(ReadMeshResponseSchema, { textureCoordinates: coordinates.slice(3) }),
  ]);
}

function textureAt(mesh: BaseMesh, u: number, v: number): number[] {
  const out = new Float64Array(2);
  mesh.textureAt(0, mesh.blendAt(0, u * GRID, v * GRID), out, 0);
  return [...out];
}

function expectNear(found: number[], [s, t]: number[]): void {
  expect(found[0]).toBeCloseTo(s, 9);
  expect(found[1]).toBeCloseTo(t, 9);
}

const square: [number, number, number][] = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]];
/** Long below, from 0 to 4; short above, from 0 to 2. Its diagonal from corner 0 to corner 2 is y = x. */
const trapezoid: [number, number, number][] = [[0, 0, 0], [4, 0, 0], [2, 2, 0], [0, 2, 0]];

describe("texture coordinates", () => {
  it("are linear on a triangle", () => {
    const mesh = meshOf([[0, 0, 0], [2, 0, 0], [0, 3, 1]], [0, 1, 4, 1, 0, 3]);
    expectNear(textureAt(mesh, 0, 0), [0, 1]);
    expectNear(textureAt(mesh, 1, 0), [4, 1]);
    expectNear(textureAt(mesh, 0, 1), [0, 3]);
    expectNear(textureAt(mesh, 0.25, 0.5), [1, 2]);
  });

  it("are linear on each side of a parallelogram's diagonal", () => {
    const sheared: [number, number, number][] = [[0, 0, 0], [0, 2, 0], [0, 3, 1], [0, 1, 1]];
    const mesh = meshOf(sheared, [0, 0, 1, 0, 1, 1, 0, 3]);
    expectNear(textureAt(mesh, 1, 0), [1, 0]);
    expectNear(textureAt(mesh, 0.5, 0.5), [0.5, 0.5]); // on the diagonal: of corners 0 and 2 alone
    expectNear(textureAt(mesh, 0.75, 0.25), [0.75, 0.25]);
    expectNear(textureAt(mesh, 0.25, 0.75), [0.25, 0.25 * 1 + 0.5 * 3]);
    expectNear(textureAt(mesh, 0, 1), [0, 3]);
  });

  it("follow the place and not the quad's own coordinates on a trapezoid", () => {
    // s = x and t = y at the corners, and so everywhere: both sides of the diagonal are linear in the place.
    const mesh = meshOf(trapezoid, [0, 0, 4, 0, 2, 2, 0, 2]);
    for (const [u, v] of [[0.5, 0.5], [0.9, 0.9], [0.1, 0.8], [0.8, 0.1], [1, 0.5]]) expectNear(textureAt(mesh, u, v), [u * (4 - 2 * v), 2 * v]);
  });

  it("choose a trapezoid's side by the place", () => {
    // Only corner 1 has s, only corner 3 has t. (0.45, 0.55) lies at (1.305, 1.1): beside corner 1, although u < v.
    const mesh = meshOf(trapezoid, [0, 0, 1, 0, 0, 0, 0, 1]);
    expectNear(textureAt(mesh, 0.45, 0.55), [(1.305 - 1.1) / 4, 0]);
    expectNear(textureAt(mesh, 0.2, 0.8), [0, (1.6 - 0.48) / 2]);
  });

  it("of a quad of which three corners lie in a line are finite", () => {
    const mesh = meshOf([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 2, 0]], [0, 0, 1, 0, 2, 0, 0, 2]);
    expectNear(textureAt(mesh, 1, 0), [1, 0]);
    expectNear(textureAt(mesh, 0, 1), [0, 2]);
    expect(textureAt(mesh, 0.5, 0.25).every(Number.isFinite)).toBe(true);
  });
});

describe("the surface of a mesh with textures", () => {
  function flushed(mesh: BaseMesh) {
    const surface = new Surface(mesh);
    const mirror = new Mirror(1, surface);
    surface.attach(mirror);
    mirror.apply({ count: 1, face: Uint32Array.of(0), path: Uint32Array.of(4 ** 14), slabs: new Uint16Array(1), rgb: Float32Array.of(1, 1, 1) }); // in four
    return surface.flush();
  }

  it("has the place on the image of each vertex", () => {
    const { positions, coordinates } = flushed(meshOf(square, [0, 0, 1, 0, 1, 1, 0, 1]));
    expect([...coordinates!.ranges]).toEqual([0, 4]);
    expect(coordinates!.data).toHaveLength(2 * 4 * SLOT_VERTICES);
    for (let n = 0; n < 4 * SLOT_VERTICES; ++n) {
      expect(coordinates!.data[2 * n]).toBeCloseTo(positions.data[3 * n] + 0.5, 6); // positions are measured from the middle
      expect(coordinates!.data[2 * n + 1]).toBeCloseTo(positions.data[3 * n + 1] + 0.5, 6);
    }
  });

  it("has nothing of the kind without textures", () => {
    expect(flushed(meshOf(square, []))).toMatchObject({ coordinates: undefined });
  });
});
