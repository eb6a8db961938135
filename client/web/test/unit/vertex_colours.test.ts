import { create } from "@bufbuild/protobuf";
import { BufferAttribute, type BufferGeometry } from "three";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { ReadMeshResponseSchema, Texture_Wrap, TextureSchema } from "../../src/gen/alvor/v1/scene_service_pb";
import { BaseMesh } from "../../src/mirror/base_mesh";
import { brightnessOf } from "../../src/mirror/brightness";
import { GRID, Mirror } from "../../src/mirror/mirror";
import { probe } from "../../src/mirror/probe";
import { SLOT_VERTICES, Surface } from "../../src/mirror/surface";
import { glbOf } from "../../src/page/downloads";
import { LINEAR } from "../../src/textures/image";
import { FRAGMENT, VERTEX } from "../../src/view/shaders";
import { Slots } from "../../src/view/slots";

type Triple = [number, number, number];

const REFLECTANCE: Triple = [0.5, 0.6, 0.8];
const EMISSION: Triple = [0, 1, 2];
const rgb = ([r, g, b]: Triple) => ({ r, g, b });
const paint = () => ({ name: "paint", emission: rgb(EMISSION), reflectance: rgb(REFLECTANCE) });
const plain = () => ({ name: "plain", emission: rgb([0, 0, 0]), reflectance: rgb(REFLECTANCE) });

/** One root of these corners, whose colours come in two messages. */
function meshOf(corners: Triple[], colours: Triple[], material = paint()): BaseMesh {
  return new BaseMesh([
    create(ReadMeshResponseSchema, {
      cornerCounts: [corners.length],
      materials: [0],
      sceneFaces: [0],
      cornerCoordinates: corners.flat(),
      neighbours: corners.map(() => 0n),
      sceneMaterials: [material],
      cornerColors: colours.flat().slice(0, 4),
    }),
    create(ReadMeshResponseSchema, { cornerColors: colours.flat().slice(4) }),
  ]);
}

const square: Triple[] = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]];
/** Red is x and green is y; blue is only on the side of corner 3. */
const ofSquare: Triple[] = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 1]];
const colourOfSquare = (x: number, y: number): Triple => [x, y, Math.max(0, y - x)];

/** What is drawn of the root in four leaves, all with this irradiance, and the mirror of it. */
function flushed(mesh: BaseMesh, irradiance: Triple = [1, 1, 1]) {
  const surface = new Surface(mesh);
  const mirror = new Mirror(1, surface);
  surface.attach(mirror);
  const child = (k: number) => (2 * k + 1) * 4 ** 14;
  mirror.apply({
    count: 4,
    face: Uint32Array.of(0, 0, 0, 0),
    path: Uint32Array.from([0, 1, 2, 3].map(child)),
    slabs: new Uint16Array(4),
    rgb: Float32Array.from([irradiance, irradiance, irradiance, irradiance].flat()),
  });
  return { mirror, change: surface.flush() };
}

function expectNear(found: Iterable<number>, expected: number[]): void {
  const values = [...found];
  expect(values).toHaveLength(expected.length);
  expected.forEach((x, n) => expect(values[n]).toBeCloseTo(x, 6)); // of float32
}

describe("colours of corners", () => {
  function colourAt(mesh: BaseMesh, u: number, v: number): Float64Array {
    const out = new Float64Array(3);
    mesh.colourAt(0, mesh.blendAt(0, u * GRID, v * GRID), out, 0);
    return out;
  }

  it("are linear on a triangle", () => {
    const mesh = meshOf([[0, 0, 0], [2, 0, 0], [0, 3, 1]], [[0, 0, 1], [1, 0, 0], [0, 1, 0.5]]);
    expectNear(colourAt(mesh, 0, 0), [0, 0, 1]);
    expectNear(colourAt(mesh, 0, 1), [0, 1, 0.5]);
    expectNear(colourAt(mesh, 0.25, 0.5), [0.25, 0.5, 0.25 + 0.5 * 0.5]);
  });

  it("are linear on each side of a quad's diagonal", () => {
    const mesh = meshOf(square, ofSquare);
    for (const [u, v] of [[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.5], [0.75, 0.25], [0.25, 0.75]]) expectNear(colourAt(mesh, u, v), colourOfSquare(u, v));
  });

  it("follow the place on a trapezoid", () => {
    // Red is x / 4 at the corners, and so everywhere.
    const mesh = meshOf([[0, 0, 0], [4, 0, 0], [2, 2, 0], [0, 2, 0]], [[0, 0, 0], [1, 0, 0], [0.5, 0, 0], [0, 0, 0]]);
    for (const [u, v] of [[0.5, 0.5], [0.45, 0.55], [0.8, 0.1]]) expectNear(colourAt(mesh, u, v), [(u * (4 - 2 * v)) / 4, 0, 0]);
  });

  it("are absent where the scene has none", () => {
    expect(meshOf(square, []).hasColours).toBe(false);
    expect(new BaseMesh([]).hasColours).toBe(false);
    expect(meshOf(square, ofSquare).hasColours).toBe(true);
  });
});

describe("the surface of a mesh with colours", () => {
  it("has the colour at each vertex", () => {
    const { positions, colours, coordinates } = flushed(meshOf(square, ofSquare)).change;
    expect([...colours!.ranges]).toEqual([...positions.ranges]);
    expect(colours!.data).toHaveLength(3 * 4 * SLOT_VERTICES);
    for (let at = 0; at < colours!.data.length; at += 3) {
      const [x, y] = [positions.data[at] + 0.5, positions.data[at + 1] + 0.5]; // positions are measured from the middle
      expectNear(colours!.data.subarray(at, at + 3), colourOfSquare(x, y));
    }
    expect(coordinates).toBeUndefined();
  });

  it("has nothing of the kind without colours", () => {
    expect(flushed(meshOf(square, [])).change.colours).toBeUndefined();
  });
});

describe("the buffers that are drawn", () => {
  it("have colours, also when they are copied or grow", () => {
    const slots = new Slots();
    const { change } = flushed(meshOf(square, ofSquare));
    slots.take(change);
    slots.take({ ...change, slotCount: 5000, positions: none(), colours: none(), values: none(), triangles: { ranges: new Uint32Array(0), data: new Uint32Array(0) } });
    const { array, itemSize } = slots.copy().getAttribute("vertexColour");
    expect([itemSize, array.length]).toEqual([3, 3 * 5000 * SLOT_VERTICES]);
    expect(array.slice(0, change.colours!.data.length)).toEqual(change.colours!.data);
  });

  it("have none without colours", () => {
    const slots = new Slots();
    slots.take(flushed(meshOf(square, [])).change);
    expect(Object.keys(slots.geometry.attributes)).toEqual(["position", "value"]);
  });

  const none = () => ({ ranges: new Uint32Array(0), data: new Float32Array(0) });
});

describe("the shaders", () => {
  /** Returns the lines that a preprocessor leaves. */
  function compiled(shader: string, defined: string[]): string {
    const isIn = [true];
    const lines = shader.split("\n").filter((line) => {
      if (line.startsWith("#ifdef")) isIn.push(defined.includes(line.split(" ")[1]));
      else if (line.startsWith("#else")) isIn.push(!isIn.pop());
      else if (line.startsWith("#endif")) isIn.pop();
      return isIn.every(Boolean) && !line.startsWith("#");
    });
    expect(isIn).toEqual([true]);
    return lines.join("\n");
  }

  it.each([[[]], [["TEXTURED"]]])("know no colours of vertices with %j", (defined) => {
    for (const shader of [VERTEX, FRAGMENT]) expect(compiled(shader, defined)).not.toMatch(/vertexColour|colourThere/);
  });

  it.each([
    [["COLOURED"], "reflectance"],
    [["COLOURED", "TEXTURED"], "there.rgb"],
  ])("multiply the reflectance by them with %j", (defined, reflectance) => {
    expect(compiled(VERTEX, defined)).toContain("in vec3 vertexColour;\nout vec3 colourThere;");
    expect(compiled(FRAGMENT, defined)).toContain("in vec3 colourThere;");
    expect(compiled(FRAGMENT, defined)).toContain(`vec3 rho = ${reflectance};\n  rho *= colourThere;`);
  });
});

describe("the probe of a coloured surface", () => {
  const irradiance: Triple = [4, 2, 1];
  const down = { x: 0, y: 0, z: -1 };
  const above = (x: number, y: number) => ({ x: x - 0.5, y: y - 0.5, z: 5 });

  it.each([[0.75, 0.25], [0.2, 0.9]])("multiplies the reflectance by the colour at (%f, %f)", (x, y) => {
    const mesh = meshOf(square, ofSquare);
    const reading = probe(mesh, flushed(mesh, irradiance).mirror, above(x, y), down)!;
    expect(reading.irradiance).toEqual(irradiance);
    expectNear(reading.radiosity, colourOfSquare(x, y).map((colour, band) => EMISSION[band] + REFLECTANCE[band] * colour * irradiance[band]));
  });

  it("multiplies the texel there by it", () => {
    const material = { ...plain(), texture: create(TextureSchema, { wrapS: Texture_Wrap.CLAMP }) };
    const mesh = new BaseMesh([
      create(ReadMeshResponseSchema, {
        cornerCounts: [4],
        materials: [0],
        sceneFaces: [0],
        cornerCoordinates: square.flat(),
        neighbours: square.map(() => 0n),
        sceneMaterials: [material],
        textureCoordinates: [0, 0, 1, 0, 1, 1, 0, 1],
        cornerColors: ofSquare.flat(),
      }),
    ]);
    const images = [{ columns: 1, rows: 1, hasOpacity: false, texels: Uint8Array.of(200, 100, 50) }];
    const { radiosity } = probe(mesh, flushed(mesh, irradiance).mirror, above(0.2, 0.9), down, images)!;
    expectNear(radiosity, [LINEAR[200] * 0.2 * 4, LINEAR[100] * 0.9 * 2, LINEAR[50] * 0.7 * 1]);
  });
});

describe("automatic exposure of a coloured surface", () => {
  const exposureOf = (mesh: BaseMesh) => brightnessOf(mesh, flushed(mesh).mirror, [0, 0, 0]).exposure;

  it("is that of a material as dark as the colours make it", () => {
    const grey = (x: number): Triple => [x, x, x];
    const dark = { ...plain(), reflectance: rgb([0.5 / 8, 0.6 / 8, 0.8 / 8]) };
    const coloured = meshOf(square, [grey(0), grey(0.25), grey(0), grey(0.25)], plain()); // of mean 1 / 8
    expect(exposureOf(coloured)).toBeCloseTo(exposureOf(meshOf(square, [], dark)), 6);
    expect(exposureOf(coloured)).toBeCloseTo(8 * exposureOf(meshOf(square, [], plain())), 6);
  });

  it("takes the bands apart", () => {
    const green = { ...plain(), reflectance: rgb([0, 0.6, 0]) };
    const coloured = meshOf(square, square.map((): Triple => [0, 1, 0]), plain());
    expect(exposureOf(coloured)).toBeCloseTo(exposureOf(meshOf(square, [], green)), 6);
  });
});

describe("the GLB of a coloured surface", () => {
  // Node.js has no FileReader, which three.js needs.
  class FileReader {
    result?: ArrayBuffer;
    onloadend?: () => void;
    readAsArrayBuffer(blob: Blob): void {
      void blob.arrayBuffer().then((bytes) => {
        this.result = bytes;
        this.onloadend!();
      });
    }
  }
  beforeEach(() => void vi.stubGlobal("FileReader", FileReader));
  afterEach(() => void vi.unstubAllGlobals());

  const EXPOSURE = 0.25;
  const MATERIALS = Float32Array.of(...EMISSION, 0, ...REFLECTANCE, 0);

  function drawnOf(mesh: BaseMesh, irradiance: Triple): BufferGeometry {
    const slots = new Slots();
    slots.take(flushed(mesh, irradiance).change);
    return slots.copy();
  }

  /** Returns the vectors of each attribute in a GLB. */
  async function attributesOf(glb: Blob): Promise<Record<string, Float32Array>> {
    const bytes = await glb.arrayBuffer();
    const jsonLength = new DataView(bytes).getUint32(12, true);
    const json = JSON.parse(new TextDecoder().decode(bytes.slice(20, 20 + jsonLength)));
    const read = (accessor: number) => {
      const { bufferView, byteOffset = 0, count, type, componentType } = json.accessors[accessor];
      expect([type, componentType]).toEqual(["VEC3", 5126]); // of float32
      const start = 28 + jsonLength + (json.bufferViews[bufferView].byteOffset ?? 0) + byteOffset;
      return new Float32Array(bytes.slice(start, start + 12 * count));
    };
    const attributes: [string, number][] = Object.entries(json.meshes[0].primitives[0].attributes);
    return Object.fromEntries(attributes.map(([name, accessor]) => [name, read(accessor)]));
  }

  it("has them in radiosity and COLOR_0, not in irradiance, and no attribute of their own", async () => {
    const irradiance: Triple = [4, 2, 1];
    const drawn = drawnOf(meshOf(square, ofSquare), irradiance);
    const written = await attributesOf(await glbOf(drawn, [0, 0, 0], MATERIALS, EXPOSURE, false));
    expect(Object.keys(written).sort()).toEqual(["COLOR_0", "POSITION", "_IRRADIANCE", "_RADIOSITY"]);
    for (const vertex of new Set(drawn.index!.array)) { // the others, middles of edges that are not drawn, have no light
      const at = 3 * vertex;
      const colour = colourOfSquare(written.POSITION[at] + 0.5, written.POSITION[at + 1] + 0.5);
      const radiosity = colour.map((share, band) => EMISSION[band] + REFLECTANCE[band] * share * irradiance[band]);
      expectNear(written._IRRADIANCE.subarray(at, at + 3), irradiance);
      expectNear(written._RADIOSITY.subarray(at, at + 3), radiosity);
      expectNear(written.COLOR_0.subarray(at, at + 3), radiosity.map((x) => Math.min(1, EXPOSURE * x)));
    }
  });

  it("has light that comes through in its radiosity", async () => {
    const drawn = drawnOf(meshOf(square, []), [1, 1, 1]);
    const transmitted = Float32Array.from({ length: 3 * drawn.getAttribute("value").count }, (_, n) => n % 3);
    drawn.setAttribute("transmitted", new BufferAttribute(transmitted, 3));
    const written = await attributesOf(await glbOf(drawn, [0, 0, 0], MATERIALS, EXPOSURE, false));
    expect(Object.keys(written).sort()).toEqual(["COLOR_0", "POSITION", "_IRRADIANCE", "_RADIOSITY"]);
    expectNear(written._RADIOSITY.subarray(0, 3), REFLECTANCE.map((x, band) => EMISSION[band] + x + band));
  });

  it("is as ever without colours", async () => {
    const written = await attributesOf(await glbOf(drawnOf(meshOf(square, []), [1, 1, 1]), [0, 0, 0], MATERIALS, EXPOSURE, false));
    expectNear(written._RADIOSITY.subarray(0, 3), REFLECTANCE.map((x, band) => EMISSION[band] + x));
  });
});
