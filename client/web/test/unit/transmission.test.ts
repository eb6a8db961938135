// Light that comes through translucent surfaces: tau times the irradiance of the other side.

import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { ReadMeshResponseSchema } from "../../src/gen/alvor/v1/scene_service_pb";
import { BaseMesh } from "../../src/mirror/base_mesh";
import { brightnessOf } from "../../src/mirror/brightness";
import { GRID, Mirror } from "../../src/mirror/mirror";
import { levelOf, mirrored } from "../../src/mirror/patch_id";
import { probe } from "../../src/mirror/probe";
import { SLOT_VERTICES, Surface, type SurfaceChange } from "../../src/mirror/surface";
import { FRAGMENT, VERTEX } from "../../src/view/shaders";
import { Slots } from "../../src/view/slots";

type Triple = [number, number, number];
type Leaf = [root: number, children: number[], irradiance: Triple, slabs?: number];

const TAU: Triple = [0.5, 0.25, 0.125];
const REFLECTANCE: Triple = [0.25, 0.25, 0.5];
const rgb = ([r, g, b]: Triple) => ({ r, g, b });
const grey = (x: number): Triple => [x, x, x];
const paper = { name: "paper", emission: rgb(grey(1)), reflectance: rgb(REFLECTANCE), twoSided: true, diffuseTransmittance: rgb(TAU) };
const board = { name: "board", emission: rgb(grey(0)), reflectance: rgb(REFLECTANCE), twoSided: true };

const quad: Triple[] = [[0, 0, 0], [4, 0, 0], [4, 2, 0], [0, 2, 0]];
const triangle: Triple[] = [[5, 0, 0], [9, 0, 0], [5, 2, 0]];
const back = ([first, ...others]: Triple[]): Triple[] => [first, ...others.reverse()];

/** Roots that are no neighbours. */
function meshOf(roots: [corners: Triple[], material: number][]): BaseMesh {
  return new BaseMesh([
    create(ReadMeshResponseSchema, {
      cornerCounts: roots.map(([corners]) => corners.length),
      materials: roots.map(([, material]) => material),
      sceneFaces: roots.map((_, root) => root),
      cornerCoordinates: roots.flatMap(([corners]) => corners.flat()),
      neighbours: roots.flatMap(([corners]) => corners.map(() => 0n)),
      sceneMaterials: [paper, board],
    }),
  ]);
}

/** As the server has them: a quad, a triangle and a quad of board, then their backs. */
const sheets = () =>
  meshOf([[quad, 0], [triangle, 0], [lowered(quad), 1], [back(quad), 0], [back(triangle), 0], [back(lowered(quad)), 1]]);
const lowered = (corners: Triple[]) => corners.map(([x, y]): Triple => [x, y, -1]);
const [QUAD, TRIANGLE, BOARD, QUAD_BACK, TRIANGLE_BACK] = [0, 1, 2, 3, 4];

const path = (children: number[]) =>
  children.reduce((bits, child, n) => bits + child * 4 ** (15 - n - 1) * 2, 0) + 4 ** (15 - children.length);

const leavesOf = (list: Leaf[]) => ({
  count: list.length,
  face: Uint32Array.from(list, ([root]) => root),
  path: Uint32Array.from(list, ([, children]) => path(children)),
  slabs: Uint16Array.from(list, ([, , , slabs = 0]) => slabs),
  rgb: Float32Array.from(list.flatMap(([, , irradiance]) => irradiance)),
});

/** A surface and what a viewer holds of it. */
class Shown {
  readonly surface: Surface;
  readonly mirror: Mirror;
  readonly slots = new Slots();
  last!: SurfaceChange;

  constructor(readonly mesh: BaseMesh) {
    this.surface = new Surface(mesh);
    this.mirror = new Mirror(mesh.rootCount, this.surface);
    this.surface.attach(this.mirror);
  }

  apply(...list: Leaf[]): void {
    this.mirror.apply(leavesOf(list));
    this.last = this.surface.flush();
    this.slots.take(this.last);
  }

  /** The vertex that is a leaf's centre nearest to a place of a root: its transmitted light. */
  centreAt(root: number, x: number, y: number): Triple {
    const isHere = (slot: number) => this.rootOf(slot) === root;
    const distance = (slot: number) => Math.hypot(...[x, y].map((c, k) => this.get("position", SLOT_VERTICES * slot)[k] + this.mesh.centre[k] - c));
    const slots = Array.from({ length: this.slots.count }, (_, slot) => slot).filter(isHere);
    return this.get("transmitted", SLOT_VERTICES * slots.sort((a, b) => distance(a) - distance(b))[0]);
  }

  get(attribute: string, vertex: number): Triple {
    const found = this.slots.geometry.getAttribute(attribute);
    return [found.getX(vertex), found.getY(vertex), found.getZ(vertex)];
  }

  rootOf(slot: number): number {
    return this.mirror.root[(this.surface as unknown as { nodeOfSlot: Int32Array }).nodeOfSlot[slot]];
  }

  transmittedByPlace = (root: number) => this.byPlace(root, "transmitted");
  irradianceByPlace = (root: number) => this.byPlace(root, "value");

  /** Returns an attribute by place, of the vertices of a root that are drawn; to 3 cm, because leaves among slabs lap over. */
  private byPlace(root: number, attribute: string): Map<string, Triple> {
    const drawn = this.slots.geometry.index!.array.slice(0, this.slots.geometry.drawRange.count);
    const ofRoot = [...drawn].filter((v) => this.rootOf(Math.floor(v / SLOT_VERTICES)) === root);
    return new Map(ofRoot.map((v) => [`${this.get("position", v).map((x) => Math.round(32 * x))}`, this.get(attribute, v)]));
  }

  /** Returns light that comes through, by root and place, of the vertices that are drawn. */
  transmitted(): Map<string, Triple> {
    const { index } = this.slots.geometry;
    const drawn = new Set(index!.array.slice(0, this.slots.geometry.drawRange.count));
    return new Map([...drawn].map((v) => [`${this.rootOf(Math.floor(v / SLOT_VERTICES))}: ${this.get("position", v)}`, this.get("transmitted", v)]));
  }
}

/** Each light at a corner or a middle of several leaves is the mean of theirs: so a number that changes evenly is itself there. */
const times = (share: Triple, light: Triple): Triple => [share[0] * light[0], share[1] * light[1], share[2] * light[2]];
const four = (root: number, irradiances: number[]): Leaf[] => irradiances.map((x, k) => [root, [k], [x, 2 * x, 4 * x]]);

describe("the other side of a translucent root", () => {
  it("is the root with its corners in reverse order, and none is one of another material", () => {
    const mesh = sheets();
    expect([0, 1, 2, 3, 4, 5].map((root) => mesh.otherSideOf(root))).toEqual([3, 4, -1, 0, 1, -1]);
    expect(mesh.isTranslucent).toBe(true);
  });

  it("is absent where nothing is translucent, and where the corners do not fit", () => {
    expect(meshOf([[quad, 1], [back(quad), 1]]).isTranslucent).toBe(false);
    expect(meshOf([[quad, 0], [back(quad), 1]]).isTranslucent).toBe(false);
    expect(meshOf([[quad, 0], [quad, 0], [lowered(quad), 0]]).isTranslucent).toBe(false);
    expect(new BaseMesh([]).otherSideOf(0)).toBe(-1);
  });

  it("has (u, v) of a point where this one has (v, u)", () => {
    const mesh = sheets();
    for (const [front, behind] of [[QUAD, QUAD_BACK], [TRIANGLE, TRIANGLE_BACK]]) {
      const [here, there] = [new Float64Array(3), new Float64Array(3)];
      mesh.position(front, GRID / 8, GRID / 2, here, 0);
      mesh.position(behind, GRID / 2, GRID / 8, there, 0);
      expect(there).toEqual(here);
    }
  });
});

describe("a mirrored path", () => {
  it("has children 1 and 2 changed on all levels", () => {
    expect(mirrored(path([]))).toBe(path([]));
    expect(mirrored(path([1, 0, 3, 2, 2]))).toBe(path([2, 0, 3, 1, 1]));
    const finest = Array.from({ length: 15 }, (_, n) => (7 * n + 3) % 4);
    expect(mirrored(path(finest))).toBe(path(finest.map((k) => [0, 2, 1, 3][k])));
  });

  it("keeps the children of slabs", () => {
    const slabs = 1 | (6 << 5); // the root along u, and an ancestor at level 2 along v
    expect(mirrored(path([1, 1, 2, 2]), slabs)).toBe(path([1, 2, 2, 1]));
  });

  it("has the same level, and mirrored again is as before", () => {
    for (const children of [[0], [3], [1, 2], [2, 2, 2, 1], Array<number>(15).fill(2)]) {
      const there = mirrored(path(children));
      expect(levelOf(there)).toBe(children.length);
      expect(mirrored(there)).toBe(path(children));
    }
  });

  it.each([[QUAD, QUAD_BACK], [TRIANGLE, TRIANGLE_BACK]])("is in the same place: of root %d on %d", (front, behind) => {
    for (const children of [[1], [3, 1], [2, 0, 3], [3, 3, 2, 1]]) {
      const other = children.map((k) => [0, 2, 1, 3][k]);
      const centreOf = (root: number, leaf: number[]) => {
        const shown = new Shown(sheets());
        shown.apply([root, leaf, [7, 7, 7]]);
        const slots = Array.from({ length: shown.slots.count }, (_, slot) => slot);
        const values = shown.slots.geometry.getAttribute("value");
        const lit = slots.find((slot) => shown.rootOf(slot) === root && values.getX(SLOT_VERTICES * slot) === 7)!;
        return shown.get("position", SLOT_VERTICES * lit);
      };
      expect(centreOf(behind, other)).toEqual(centreOf(front, children));
    }
  });
});

describe("transmitted light", () => {
  const QUARTERS = [[1, 0.5], [3, 0.5], [1, 1.5], [3, 1.5]]; // middles of the quad's children
  const MIRRORED = [0, 2, 1, 3];

  it("of a front is tau times the irradiance of its back, and of the back of its front", () => {
    const shown = new Shown(sheets());
    shown.apply(...four(QUAD, [1, 2, 3, 4]), ...four(QUAD_BACK, [5, 6, 7, 8]));
    QUARTERS.forEach(([x, y], k) => {
      const ofBack = [5, 6, 7, 8][MIRRORED[k]];
      expect(shown.centreAt(QUAD, x, y)).toEqual(times(TAU, [ofBack, 2 * ofBack, 4 * ofBack]));
      expect(shown.centreAt(QUAD_BACK, x, y)).toEqual(times(TAU, [1 + k, 2 + 2 * k, 4 + 4 * k]));
    });
  });

  it.each([[QUAD, QUAD_BACK], [TRIANGLE, TRIANGLE_BACK]])("of each vertex of root %d is tau times what root %d shows there", (front, behind) => {
    const shown = new Shown(sheets());
    shown.apply(...four(front, [1, 1, 1, 1]), ...four(behind, [5, 6, 7, 8]));
    const within = (k: number, leaves: Leaf[]) => leaves.map(([root, children, light]): Leaf => [root, [k, ...children], light]);
    shown.apply(...within(1, four(front, [1, 1, 1, 1])), ...within(2, four(behind, [9, 20, 30, 50])));
    const { index, drawRange } = shown.slots.geometry;
    const drawn = [...new Set(index!.array.slice(0, drawRange.count))];
    const placesOf = (root: number, attribute: string) =>
      drawn.filter((v) => shown.rootOf(Math.floor(v / SLOT_VERTICES)) === root).map((v) => [shown.get("position", v).join(), shown.get(attribute, v)] as const);
    const transmitted = placesOf(front, "transmitted"); // of some places several times, by each leaf
    const irradiance = new Map(placesOf(behind, "value"));
    expect(new Set(transmitted.map(([place]) => place))).toEqual(new Set(irradiance.keys()));
    for (const [place, light] of transmitted) times(TAU, irradiance.get(place)!).forEach((x, band) => expect(light[band]).toBeCloseTo(x, 5));
  });

  it("of each vertex of slabs is tau times what the slabs behind show there", () => {
    const shown = new Shown(sheets());
    // Slabs along u, the third of them in slabs along v; on the back slabs along v, the third of them in slabs along u.
    const slabs = (root: number, light: number, outer: number, inner: number): Leaf[] => [
      ...[0, 1, 3].map((k): Leaf => [root, [k], grey(light + k), outer]),
      ...[0, 1, 2, 3].map((k): Leaf => [root, [2, k], grey(light + 10 * k), outer | (inner << 5)]),
    ];
    shown.apply(...slabs(QUAD, 1, 1, 4), ...slabs(QUAD_BACK, 50, 2, 3));
    expect(shown.transmittedByPlace(QUAD).size).toBe(10 + 6 + 7); // corners of the outer and the inner slabs, and centres
    for (const [front, behind] of [[QUAD, QUAD_BACK], [QUAD_BACK, QUAD]])
      for (const [place, light] of shown.transmittedByPlace(front))
        times(TAU, shown.irradianceByPlace(behind).get(place)!).forEach((x, band) => expect(light[band]).toBeCloseTo(x, 5));
  });

  it("changes when only the light of the back does, and only that is written again", () => {
    const shown = new Shown(sheets());
    shown.apply(...four(QUAD, [1, 2, 3, 4]), ...four(QUAD_BACK, [5, 6, 7, 8]), [BOARD, [], grey(3)]);
    shown.apply([QUAD_BACK, [1], grey(40)]);
    expect(shown.centreAt(QUAD, 1, 1.5)).toEqual(times(TAU, grey(40)));
    expect(shown.centreAt(QUAD, 3, 0.5)).toEqual(times(TAU, [7, 14, 28]));
    const slotsOf = ({ ranges }: { ranges: Uint32Array }) =>
      Array.from({ length: ranges.length / 2 }, (_, n) => Array.from({ length: ranges[2 * n + 1] }, (_, k) => ranges[2 * n] + k)).flat();
    const frontsWritten = slotsOf(shown.last.transmitted!).filter((slot) => shown.rootOf(slot) === QUAD);
    expect(frontsWritten).toHaveLength(4); // all four meet in the middle
    expect(shown.surface.flush().transmitted!.data).toHaveLength(0);
  });

  it("is that of the leaf behind, or of the mean of the leaves behind, where the other side is split otherwise", () => {
    const shown = new Shown(sheets());
    shown.apply([QUAD_BACK, [], grey(8)], ...four(QUAD, [1, 2, 3, 4]));
    for (const light of shown.transmitted()) if (light[0].startsWith(`${QUAD}:`)) expect(light[1]).toEqual(times(TAU, grey(8)));
    expect(shown.centreAt(QUAD_BACK, 2, 1)).toEqual(times(TAU, [2.5, 5, 10]));
    const corner = [...shown.transmitted()].find(([place]) => place.startsWith(`${QUAD_BACK}:`) && place.endsWith(`${4 - shown.mesh.centre[0]},${-shown.mesh.centre[1]},${-shown.mesh.centre[2]}`))!;
    expect(corner[1]).toEqual(times(TAU, [2, 4, 8])); // of child 1
    shown.apply([QUAD, [0], grey(5)]);
    expect(shown.centreAt(QUAD_BACK, 2, 1)).toEqual(times(TAU, [3.5, (5 + 4 + 6 + 8) / 4, (5 + 8 + 12 + 16) / 4]));
  });

  it("is that of the mean of the node around it where the other side is split into quarters and this one into slabs", () => {
    const shown = new Shown(sheets());
    shown.apply(...four(QUAD_BACK, [1, 2, 3, 10]), [QUAD, [2], grey(1), 1]);
    expect(shown.centreAt(QUAD, 2.5, 1)).toEqual(times(TAU, [4, 8, 16]));
    shown.apply([QUAD_BACK, [2], grey(8), 2]);
    expect(shown.centreAt(QUAD, 2.5, 1)).toEqual(times(TAU, grey(8)));
  });

  it("is the same however the leaves came", () => {
    const all = [QUAD, QUAD_BACK, TRIANGLE, TRIANGLE_BACK].flatMap((root, n) => four(root, [1, 2, 3, 4].map((x) => x + n)));
    const deep: Leaf[] = [[QUAD, [3, 1], grey(9)], [QUAD_BACK, [3, 2], grey(4)], [TRIANGLE, [3, 3], grey(6)], [TRIANGLE_BACK, [3, 3], grey(2)]];
    const atOnce = new Shown(sheets());
    atOnce.mirror.apply(leavesOf(all));
    atOnce.apply(...deep);
    const oneByOne = new Shown(sheets());
    for (const leaf of [...all, ...deep]) oneByOne.apply(leaf);
    const near = (light: Triple) => light.map((x) => x.toPrecision(5));
    const [a, b] = [atOnce.transmitted(), oneByOne.transmitted()];
    expect([...b.keys()].sort()).toEqual([...a.keys()].sort());
    for (const [place, light] of a) expect(near(b.get(place)!)).toEqual(near(light));
  });

  it("is 0 for what is not translucent", () => {
    const shown = new Shown(sheets());
    shown.apply([BOARD, [], grey(3)], [BOARD + 3, [], grey(7)], [QUAD_BACK, [], grey(1)]);
    for (const [place, light] of shown.transmitted()) if (place.startsWith(`${BOARD}:`)) expect(light).toEqual([0, 0, 0]);
  });

  it("is nothing that is sent or drawn where nothing is translucent", () => {
    const shown = new Shown(meshOf([[quad, 1], [back(quad), 1]]));
    shown.apply([0, [], grey(1)]);
    expect(shown.last.transmitted).toBeUndefined();
    expect(Object.keys(shown.slots.geometry.attributes)).toEqual(["position", "value"]);
  });
});

describe("a reading of a translucent surface", () => {
  const ahead = (shown: Shown, x: number, y: number) => ({ x: x - shown.mesh.centre[0], y: y - shown.mesh.centre[1], z: 5 });
  const down = { x: 0, y: 0, z: -1 };

  it("has in its radiosity the light that comes through from the slab behind", () => {
    const shown = new Shown(sheets());
    const slabs = (root: number, light: number, code: number) => [0, 1, 2, 3].map((k): Leaf => [root, [k], grey(light + k), code]);
    shown.apply(...slabs(QUAD, 1, 1), ...slabs(QUAD_BACK, 5, 2)); // four beside each other in x
    const { radiosity, irradiance } = probe(shown.mesh, shown.mirror, ahead(shown, 2.5, 1.9), down)!;
    expect(irradiance).toEqual(grey(3));
    expect(radiosity).toEqual([1 + 0.25 * 3 + 0.5 * 7, 1 + 0.25 * 3 + 0.25 * 7, 1 + 0.5 * 3 + 0.125 * 7]);
  });

  it("has in its radiosity the light that comes through from the leaf behind", () => {
    const shown = new Shown(sheets());
    shown.apply(...four(QUAD, [1, 2, 3, 4]), ...four(QUAD_BACK, [5, 6, 7, 8]));
    const { radiosity, irradiance } = probe(shown.mesh, shown.mirror, ahead(shown, 3.5, 0.2), down)!;
    expect(irradiance).toEqual([2, 4, 8]);
    expect(radiosity).toEqual([1 + 0.25 * 2 + 0.5 * 7, 1 + 0.25 * 4 + 0.25 * 14, 1 + 0.5 * 8 + 0.125 * 28]);
  });
});

describe("automatic exposure", () => {
  it("counts light that comes through", () => {
    const dark = { ...paper, emission: rgb(grey(0)) };
    const mesh = sheets();
    mesh.materials[0] = create(ReadMeshResponseSchema, { sceneMaterials: [{ ...dark, diffuseTransmittance: rgb(grey(0.5)), reflectance: rgb(grey(0)) }] }).sceneMaterials[0];
    mesh.materials[1] = create(ReadMeshResponseSchema, { sceneMaterials: [{ ...dark, diffuseTransmittance: undefined, reflectance: rgb(grey(0)) }] }).sceneMaterials[0];
    const mirror = new Mirror(mesh.rootCount);
    mirror.apply(leavesOf([[QUAD_BACK, [], grey(2)], [TRIANGLE_BACK, [], grey(2)]]));
    const { exposure } = brightnessOf(mesh, mirror, [0, 0, 0]);
    expect(exposure * 0.5 * 2).toBeCloseTo(0.25, 1);
  });
});

describe("the shaders", () => {
  it("know of transmitted light only with TRANSLUCENT", () => {
    for (const shader of [VERTEX, FRAGMENT]) {
      const without = shader.replace(/#ifdef TRANSLUCENT[^#]*#endif/g, "");
      expect(shader).toMatch(/transmitted/);
      expect(without).not.toMatch(/transmitted|transmittance/);
    }
  });
});
