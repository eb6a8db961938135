// The root patches that patch ids refer to, as ReadMesh sends them.

import { Quantity, UpAxis, type Light, type Material, type ReadMeshResponse, type Rgb, type SceneObject } from "../gen/alvor/v1/scene_service_pb";
import type { Look, LookOfObject } from "../gen/alvor/v1/solve_service_pb";
import { type Blend, blendOnQuad } from "./blend";
import { isAddition } from "./copies";
import { GRID } from "./mirror";

/** Corners are numbered through all roots: corner c of root r is firstCorner[r] + c, and so is the edge that begins there. */
export class BaseMesh {
  readonly rootCount: number;
  readonly firstCorner: Uint32Array;
  /** x, y, z of each corner, metres, from the middle of the mesh. */
  readonly corners: Float64Array;
  readonly centre: [number, number, number];
  /** Longest side of the box around all, metres. */
  readonly extent: number;
  readonly material: Uint32Array;
  readonly sceneFace: Uint32Array;
  /** 1 + the second face of roots that are two triangles of the scene; 0 elsewhere. */
  private readonly secondSceneFace: Uint32Array;
  /** Or y. */
  readonly isZUp: boolean;
  /** Light is in lumens and lx, not in watts and W/m2. */
  readonly isPhotometric: boolean;
  materials: Material[];
  /** Lights of the scene that are not faces, and its objects, in the order of their faces. */
  readonly lights: Light[];
  readonly objects: SceneObject[];
  /** Lights that came with objects that edits have added, by the name of the object. */
  readonly lightsOfAdded: ReadonlyMap<string, Light[]>;
  /** Some material has a texture, and so corners have texture coordinates. */
  readonly hasTextures: boolean;
  /** Some face has colours at its corners; corners of the other faces are white then. They multiply the reflectance. */
  readonly hasColours: boolean;
  /** Some root lets through light that its other side receives, scattered: see otherSideOf(). */
  readonly isTranslucent: boolean;
  /** Of each root, m2. */
  readonly area: Float64Array;
  /** The edge on the other side, or -1. */
  private readonly opposite: Int32Array;
  private readonly smooth: Uint8Array;
  /** Corners in one place have one number, and so have those around which the surface is smooth. */
  private readonly place: Uint32Array;
  private readonly smoothPlace: Uint32Array;
  /** s, t of each corner on the image of its material's texture; empty without textures. */
  private readonly textureCoordinates: Float32Array;
  /** Red, green, blue of each corner, and the mean of each root's corners; both are empty without colours. */
  private readonly colours: Float32Array;
  private readonly meanColours: Float32Array;
  /** Of each translucent root the one on its other side, -1 elsewhere; empty if none is translucent. */
  private readonly otherSide: Int32Array;
  /** Before all edits. */
  private readonly submitted: { materials: Material[]; material: Uint32Array; corners: Float64Array };
  /** 1 for roots that an edit took away. */
  private readonly hidden: Uint8Array;
  /** 1 for roots that an edit took away or moved. */
  private readonly edited: Uint8Array;
  /** The object of each root: its place in `objects`, or -1. */
  private readonly objectOfRoot: Int32Array;
  private readonly point = new Float64Array(3);

  /** `framed`: messages whose roots the centre and the extent are of; all if it is not given. */
  constructor(messages: ReadMeshResponse[], framed = messages.length) {
    const counts = messages.flatMap((message) => message.cornerCounts);
    this.rootCount = counts.length;
    this.firstCorner = new Uint32Array(counts.length + 1);
    counts.forEach((count, root) => (this.firstCorner[root + 1] = this.firstCorner[root] + count));
    this.material = Uint32Array.from(messages.flatMap((message) => message.materials));
    this.sceneFace = Uint32Array.from(messages.flatMap((message) => message.sceneFaces));
    this.secondSceneFace = Uint32Array.from(messages.flatMap((message) => message.secondSceneFaces));
    this.isZUp = messages[0]?.upAxis === UpAxis.Z;
    this.isPhotometric = messages[0]?.quantity === Quantity.PHOTOMETRIC;
    this.materials = messages.flatMap((message) => message.sceneMaterials);
    this.lights = messages.flatMap((message) => (isAddition(message) ? [] : message.sceneLights));
    this.lightsOfAdded = new Map(messages.filter(isAddition).map(({ sceneObjects: [{ name }], sceneLights }) => [name, sceneLights]));
    this.objects = messages.flatMap((message) => message.sceneObjects);
    this.corners = Float64Array.from(messages.flatMap((message) => message.cornerCoordinates));
    const framedNumbers = messages.slice(0, framed).reduce((count, { cornerCoordinates }) => count + cornerCoordinates.length, 0);
    ({ centre: this.centre, extent: this.extent } = moveToMiddle(this.corners, framedNumbers));
    this.submitted = { materials: this.materials, material: this.material.slice(), corners: this.corners.slice() };
    this.objectOfRoot = Int32Array.from(this.sceneFace, (face) => this.numberOfObject(face));
    this.hidden = Uint8Array.from(this.objectOfRoot, (object) => Number(this.objects[object]?.hidden ?? false));
    this.edited = new Uint8Array(this.rootCount);
    const cornerCount = this.firstCorner[this.rootCount];
    this.textureCoordinates = Float32Array.from(messages.flatMap((message) => message.textureCoordinates));
    this.hasTextures = cornerCount > 0 && this.textureCoordinates.length === 2 * cornerCount;
    this.colours = Float32Array.from(messages.flatMap((message) => message.cornerColors));
    this.hasColours = cornerCount > 0 && this.colours.length === 3 * cornerCount;
    this.meanColours = this.hasColours ? this.meansOfRoots(this.colours) : new Float32Array(0);
    this.otherSide = this.pairSides();
    this.isTranslucent = this.otherSide.some((other) => other >= 0);
    this.opposite = new Int32Array(cornerCount).fill(-1);
    this.smooth = new Uint8Array(cornerCount);
    let corner = 0;
    for (const message of messages) for (const code of message.neighbours) this.setNeighbour(corner++, Number(code));
    this.place = this.joined(() => true);
    this.smoothPlace = this.joined((edge) => this.smooth[edge] !== 0);
    this.area = Float64Array.from({ length: this.rootCount }, (_, root) => this.areaOf(root));
  }

  cornersOf(root: number): number {
    return this.firstCorner[root + 1] - this.firstCorner[root];
  }

  /**
   * Returns the root that faces the other way in the same place, if light comes through from there scattered; else -1. Its corners are this
   * root's in the order 0, n - 1, ..., 1, so its (u, v) is this root's (v, u).
   */
  otherSideOf(root: number): number {
    return this.otherSide[root] ?? -1;
  }

  /** Returns the share of the other side's irradiance that comes through. Requires: otherSideOf(root) >= 0. */
  transmittanceOf(root: number): Rgb {
    return this.materials[this.material[root]].diffuseTransmittance!;
  }

  /** The scene's faces that a root stands for: one, or two triangles. */
  sceneFacesOf(root: number): number[] {
    const second = this.secondSceneFace[root] ?? 0;
    return second > 0 ? [this.sceneFace[root], second - 1] : [this.sceneFace[root]];
  }

  /** Returns the object that a face of the scene belongs to. */
  objectOfFace(face: number): SceneObject | undefined {
    return this.objects[this.numberOfObject(face)];
  }

  isHidden(root: number): boolean {
    return this.hidden[root] !== 0;
  }

  /** Makes surfaces look as edits have made them, and returns which roots have other materials or lie elsewhere than before. */
  applyLook(look: Look): { relit: Set<number>; moved: Set<number> } {
    return { relit: this.applyMaterials(look), moved: this.applyPlaces(look.objects) };
  }

  /** Returns the place in `objects` of the one that a face of the scene belongs to, or -1. Objects come in the order of their faces. */
  numberOfObject(face: number): number {
    let low = 0;
    let high = this.objects.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.objects[middle].firstFace <= face) low = middle + 1;
      else high = middle;
    }
    const last = this.objects[low - 1];
    return last && face < last.firstFace + last.faceCount ? low - 1 : -1;
  }

  private applyPlaces(objects: LookOfObject[]): Set<number> {
    const looks = new Map(objects.map((object) => [object.number, object]));
    const moved = new Set<number>();
    for (let root = 0; root < this.rootCount; ++root) {
      const look = looks.get(this.objectOfRoot[root]);
      if (!look && this.edited[root] === 0) continue;
      this.edited[root] = Number(look !== undefined);
      const isHidden = Number(look?.hidden ?? false);
      let isMoved = isHidden !== this.hidden[root];
      this.hidden[root] = isHidden;
      for (let corner = this.firstCorner[root]; corner < this.firstCorner[root + 1]; ++corner) {
        const place = this.placed(corner, look?.motion ?? []);
        isMoved ||= place.some((x, k) => x !== this.corners[3 * corner + k]);
        this.corners.set(place, 3 * corner);
      }
      if (isMoved) moved.add(root);
    }
    return moved;
  }

  /** Returns where a motion puts a corner, from the middle of the mesh. */
  private placed(corner: number, motion: number[]): number[] {
    const from = [...this.submitted.corners.subarray(3 * corner, 3 * corner + 3)];
    if (motion.length < 12) return from;
    const [x, y, z] = from.map((value, k) => value + this.centre[k]);
    return [0, 1, 2].map((k) => x * motion[k] + y * motion[3 + k] + z * motion[6 + k] + motion[9 + k] - this.centre[k]);
  }

  private applyMaterials(look: Look): Set<number> {
    const before = this.material.slice();
    this.materials = this.submitted.materials.slice();
    for (const { number, material } of look.materials)
      this.materials[number] = { ...material!, texture: this.materials[number]?.texture };
    const others = [...look.faces].sort((a, b) => a.firstFace - b.firstFace);
    for (let root = 0; root < this.rootCount; ++root) {
      const run = others.findLast(({ firstFace }) => firstFace <= this.sceneFace[root]);
      const isOther = run !== undefined && this.sceneFace[root] < run.firstFace + run.faceCount;
      this.material[root] = isOther ? run.material : this.submitted.material[root];
    }
    return new Set([...before.keys()].filter((root) => before[root] !== this.material[root]));
  }

  /** Writes x, y, z of a point of a root, u = i / GRID and v = j / GRID, to `out[at]`. Neighbours agree on shared points. */
  position(root: number, i: number, j: number, out: Float32Array | Float64Array, at: number): void {
    const u = i / GRID;
    const v = j / GRID;
    const c = 3 * this.firstCorner[root];
    const p = this.corners;
    if (this.cornersOf(root) === 3) {
      const w = 1 - u - v;
      for (let x = 0; x < 3; ++x) out[at + x] = p[c + x] * w + p[c + 3 + x] * u + p[c + 6 + x] * v;
    } else {
      for (let x = 0; x < 3; ++x)
        out[at + x] =
          (p[c + x] * (1 - u) + p[c + 3 + x] * u) * (1 - v) + (p[c + 9 + x] * (1 - u) + p[c + 6 + x] * u) * v;
    }
  }

  /** Returns where a point of a root lies among its corners: u = i / GRID and v = j / GRID. */
  blendAt(root: number, i: number, j: number): Blend {
    if (this.cornersOf(root) === 3) return { second: 1, ofSecond: i / GRID, ofThird: j / GRID };
    this.position(root, i, j, this.point, 0);
    const first = 3 * this.firstCorner[root];
    return blendOnQuad(this.corners.subarray(first, first + 12), this.point);
  }

  /** Writes s, t of a point of a root to `out[at]`. Requires: hasTextures. */
  textureAt(root: number, blend: Blend, out: Float32Array | Float64Array, at: number): void {
    this.mix(this.textureCoordinates, 2, root, blend, out, at);
  }

  /** Writes red, green, blue of a point of a root, by which the reflectance is multiplied, to `out[at]`. Requires: hasColours. */
  colourAt(root: number, blend: Blend, out: Float32Array | Float64Array, at: number): void {
    this.mix(this.colours, 3, root, blend, out, at);
  }

  /** Returns the mean reflectance of a root's material, times the mean of the colours of the root's corners. */
  meanReflectanceOf(root: number): { r: number; g: number; b: number } {
    const reflectance = this.materials[this.material[root]].reflectance!;
    if (!this.hasColours) return reflectance;
    const colour = (band: number) => this.meanColours[3 * root + band];
    return { r: reflectance.r * colour(0), g: reflectance.g * colour(1), b: reflectance.b * colour(2) };
  }

  /** Points in one place have this number in common. */
  placeKey(root: number, i: number, j: number): number {
    const edge = this.edgeAt(root, i, j);
    if (edge < 0) return (root * GRID + i) * GRID + j;
    const first = this.firstCorner[root];
    const along = this.along(root, edge, i, j);
    if (along === 0) return CORNERS - this.place[first + edge];
    const other = this.opposite[first + edge];
    return other < 0 || first + edge < other ? edgeKey(first + edge, along) : edgeKey(other, GRID - along);
  }

  /** Points around which the surface is smooth have this number in common; `place` is their place's. */
  smoothKey(root: number, i: number, j: number, place: number): number {
    const edge = this.edgeAt(root, i, j);
    if (edge < 0) return place;
    const first = this.firstCorner[root];
    const along = this.along(root, edge, i, j);
    if (along === 0) return SMOOTH_CORNERS - this.smoothPlace[first + edge];
    return this.smooth[first + edge] !== 0 ? place : edgeKey(first + edge, along) - CREASES;
  }

  /** The edge of the root on which a point lies, of two the one that begins there; -1 inside. */
  private edgeAt(root: number, i: number, j: number): number {
    if (this.cornersOf(root) === 4) {
      if (j === 0) return i === GRID ? 1 : 0;
      if (i === GRID) return j === GRID ? 2 : 1;
      if (j === GRID) return i === 0 ? 3 : 2;
      return i === 0 ? 3 : -1;
    }
    if (j === 0) return i === GRID ? 1 : 0;
    if (i + j === GRID) return i === 0 ? 2 : 1;
    return i === 0 ? 2 : -1;
  }

  private along(root: number, edge: number, i: number, j: number): number {
    if (edge === 0) return i;
    if (edge === 1) return j;
    if (this.cornersOf(root) === 4) return edge === 2 ? GRID - i : GRID - j;
    return GRID - j;
  }

  private setNeighbour(edge: number, code: number): void {
    if (code === 0) return;
    const word = code - 1;
    this.smooth[edge] = word & 1;
    this.opposite[edge] = this.firstCorner[Math.floor(word / 8)] + ((word >> 1) & 3);
  }

  private rootOfCorner(corner: number): number {
    let low = 0;
    let high = this.rootCount;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.firstCorner[middle] <= corner) low = middle;
      else high = middle;
    }
    return low;
  }

  private after(corner: number): number {
    const root = this.rootOfCorner(corner);
    return corner + 1 === this.firstCorner[root + 1] ? this.firstCorner[root] : corner + 1;
  }

  /** Of each corner the smallest one that edges of this kind lead to. */
  private joined(joins: (edge: number) => boolean): Uint32Array {
    const group = Uint32Array.from(this.opposite, (_, corner) => corner);
    const find = (corner: number): number => {
      while (group[corner] !== corner) corner = group[corner] = group[group[corner]];
      return corner;
    };
    const join = (a: number, b: number) => {
      const [low, high] = [find(a), find(b)].sort((x, y) => x - y);
      group[high] = low;
    };
    this.opposite.forEach((other, edge) => {
      if (other < 0 || !joins(edge)) return;
      join(edge, this.after(other));
      join(this.after(edge), other);
    });
    return group.map((_, corner) => find(corner));
  }

  /** The server does not say which roots are two sides of one face: they have one material, and the same corners in reverse order. */
  private pairSides(): Int32Array {
    const isTranslucent = this.materials.map(({ diffuseTransmittance: t }) => t !== undefined && (t.r > 0 || t.g > 0 || t.b > 0));
    if (!isTranslucent.includes(true)) return new Int32Array(0);
    const otherSide = new Int32Array(this.rootCount).fill(-1);
    const unpaired = new Map<string, number>(); // by the corners that the other side has
    for (let root = 0; root < this.rootCount; ++root) {
      if (!isTranslucent[this.material[root]]) continue;
      const [first, ...others] = this.cornerNamesOf(root);
      const name = [this.material[root], first, ...others].join();
      const other = unpaired.get(name);
      if (other === undefined) {
        unpaired.set([this.material[root], first, ...others.reverse()].join(), root);
        continue;
      }
      unpaired.delete(name);
      otherSide[root] = other;
      otherSide[other] = root;
    }
    return otherSide;
  }

  private cornerNamesOf(root: number): string[] {
    const first = this.firstCorner[root];
    return Array.from({ length: this.cornersOf(root) }, (_, c) => this.corners.subarray(3 * (first + c), 3 * (first + c + 1)).join());
  }

  /** Mixes three corners' values, of which each corner has `count`, and writes them to `out[at]`. */
  private mix(
    values: Float32Array,
    count: number,
    root: number,
    { second, ofSecond, ofThird }: Blend,
    out: Float32Array | Float64Array,
    at: number,
  ): void {
    const a = count * this.firstCorner[root];
    const b = a + count * second;
    const c = b + count;
    const ofFirst = 1 - ofSecond - ofThird;
    for (let n = 0; n < count; ++n) out[at + n] = values[a + n] * ofFirst + values[b + n] * ofSecond + values[c + n] * ofThird;
  }

  /** Returns three means of each root: of the three values of each of its corners. */
  private meansOfRoots(values: Float32Array): Float32Array {
    const means = new Float32Array(3 * this.rootCount);
    for (let root = 0; root < this.rootCount; ++root)
      for (let corner = this.firstCorner[root]; corner < this.firstCorner[root + 1]; ++corner)
        for (let n = 0; n < 3; ++n) means[3 * root + n] += values[3 * corner + n] / this.cornersOf(root);
    return means;
  }

  private areaOf(root: number): number {
    const corner = (c: number) => this.corners.subarray(3 * (this.firstCorner[root] + c));
    const [a, b, c] = [corner(0), corner(1), corner(2)];
    const d = this.cornersOf(root) === 4 ? corner(3) : a;
    const p = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    const q = this.cornersOf(root) === 4 ? [d[0] - b[0], d[1] - b[1], d[2] - b[2]] : [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    return Math.hypot(p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]) / 2;
  }
}

// Keys of points inside roots are not negative; the others lie in ranges below.
const edgeKey = (edge: number, along: number) => -(edge * GRID + along) - 1;
const CREASES = 2 ** 46;
const CORNERS = -(2 ** 50);
const SMOOTH_CORNERS = -(2 ** 51);

/** Moves corners from the middle of those that the first `framed` numbers are of. */
function moveToMiddle(corners: Float64Array, framed: number): { centre: [number, number, number]; extent: number } {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  corners.subarray(0, framed).forEach((x, n) => {
    low[n % 3] = Math.min(low[n % 3], x);
    high[n % 3] = Math.max(high[n % 3], x);
  });
  const centre: [number, number, number] = [0, 1, 2].map((k) => (low[k] + high[k]) / 2) as [number, number, number];
  corners.forEach((x, n) => (corners[n] = x - centre[n % 3]));
  return { centre, extent: Math.max(...high.map((x, k) => x - low[k])) };
}
