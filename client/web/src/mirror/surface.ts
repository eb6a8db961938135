// What is drawn of a mirror: for each leaf a slot of nine vertices, its centre, four corners and four middles of edges. A middle is opened
// where a neighbour has a corner there, and lies in the corner before it elsewhere, so that no crack opens; a triangle's fourth corner
// is its first. Only slots that changed are written again.

import type { BaseMesh, Point } from "./base_mesh";
import { type Mirror, type MirrorListener, GRID, grown } from "./mirror";

export const SLOT_VERTICES = 9;
export const SLOT_INDICES = 24;
const POINTS = 8;

/** Slots that changed since the last time: pairs of the first and how many, and their new contents one after the other. */
export interface Change {
  ranges: Uint32Array;
  data: Float32Array;
}

export interface SurfaceChange {
  slotCount: number;
  /** x, y, z of each vertex, metres from the middle of the mesh. */
  positions: Change;
  /** Irradiance r, g, b, W/m2, and the index of the material. */
  values: Change;
}

const VALUES = 1;
const POSITIONS = 2;

export class Surface implements MirrorListener {
  private slotCount = 0;
  private nodeOfSlot = new Int32Array(1024);
  private slotOfNode = new Int32Array(1024).fill(-1);
  // Of each node: corner 0 on the root's grid, and its side; negative for a triangle that is turned by half a circle.
  private nodeI = new Int32Array(1024);
  private nodeJ = new Int32Array(1024);
  private nodeSize = new Int32Array(1024);
  private readonly places = new PointTable();
  private readonly smooth = new PointTable();
  private cornersHere = new Int32Array(1024); // by place: how many leaves have a corner there
  private pointValue = new Float32Array(3 * 1024); // by smooth point
  private readonly dirtySlots = new DirtySet();
  private readonly dirtyPoints = new DirtySet();
  private mirror!: Mirror;

  constructor(private readonly mesh: BaseMesh) {}

  /** Requires: a mirror of nothing but roots. */
  attach(mirror: Mirror): void {
    this.mirror = mirror;
    for (let root = 0; root < mirror.rootCount; ++root) {
      this.reserveNodes(root + 1);
      this.nodeSize[root] = GRID;
      this.newSlot(root);
    }
  }

  onValue(node: number): void {
    this.mark(this.slotOfNode[node], VALUES);
    for (let k = 0; k < POINTS; ++k) this.dirtyPoints.add(this.smooth.pointOf[POINTS * this.slotOfNode[node] + k], VALUES);
  }

  onSplit(node: number, first: number): void {
    this.reserveNodes(first + 4);
    for (let k = 0; k < 4; ++k) this.placeChild(node, first + k, k);
    const slot = this.slotOfNode[node];
    for (let k = 1; k < 4; ++k) this.newSlot(first + k);
    this.unlink(slot);
    this.slotOfNode[node] = -1;
    this.setSlot(slot, first);
  }

  /** What must be drawn anew. */
  flush(): SurfaceChange {
    for (const point of this.dirtyPoints.list) {
      this.evaluate(point);
      this.smooth.forEach(point, (link) => this.mark(link >> 3, VALUES));
    }
    this.dirtyPoints.clear();
    const all = this.dirtySlots.list.sort((a, b) => a - b);
    const moved = all.filter((slot) => this.dirtySlots.flags[slot] & POSITIONS);
    const change: SurfaceChange = {
      slotCount: this.slotCount,
      positions: collect(moved, 3 * SLOT_VERTICES, (slot, out, at) => this.writePositions(slot, out, at)),
      values: collect(all, 4 * SLOT_VERTICES, (slot, out, at) => this.writeValues(slot, out, at)),
    };
    this.dirtySlots.clear();
    return change;
  }

  /** How many vertices could be drawn now without a crack: all of them once neighbours are one level apart at most. */
  get slots(): number {
    return this.slotCount;
  }

  private isQuad(node: number): boolean {
    return this.mesh.cornersOf(this.mirror.root[node]) === 4;
  }

  private placeChild(parent: number, child: number, k: number): void {
    const half = this.nodeSize[parent] / 2;
    const inner = k === 3 && !this.isQuad(parent);
    const column = this.isQuad(parent) ? k & 1 : Number(k === 1 || inner);
    const row = this.isQuad(parent) ? k >> 1 : Number(k === 2 || inner);
    this.nodeI[child] = this.nodeI[parent] + column * half;
    this.nodeJ[child] = this.nodeJ[parent] + row * half;
    this.nodeSize[child] = inner ? -half : half;
  }

  private newSlot(node: number): void {
    const slot = this.slotCount++;
    if (slot >= this.nodeOfSlot.length) this.nodeOfSlot = grown(this.nodeOfSlot, Int32Array, 2 * slot);
    this.setSlot(slot, node);
  }

  private setSlot(slot: number, node: number): void {
    this.nodeOfSlot[slot] = node;
    this.slotOfNode[node] = slot;
    for (let k = 0; k < POINTS; ++k) this.link(slot, k);
    this.mark(slot, VALUES | POSITIONS);
  }

  /** Corners 0 to 3, then the middles of the edges that begin at them. */
  private point(node: number, k: number): Point {
    const i = this.nodeI[node];
    const j = this.nodeJ[node];
    const size = this.nodeSize[node];
    const corner = (c: number): Point =>
      this.isQuad(node)
        ? { i: i + (c === 1 || c === 2 ? size : 0), j: j + (c >= 2 ? size : 0) }
        : { i: i + (c === 1 ? size : 0), j: j + (c === 2 ? size : 0) };
    if (k < 4) return corner(k);
    const a = corner(k - 4);
    const b = corner((k - 3) % 4);
    return { i: (a.i + b.i) / 2, j: (a.j + b.j) / 2 };
  }

  /** A triangle's last corner and edge are none, and edges of the finest grid have no middle. */
  private hasPoint(node: number, k: number): boolean {
    if ((k === 3 || k === 7) && !this.isQuad(node)) return false;
    return k < 4 || Math.abs(this.nodeSize[node]) > 1;
  }

  private link(slot: number, k: number): void {
    const node = this.nodeOfSlot[slot];
    const at = POINTS * slot + k;
    if (!this.hasPoint(node, k)) {
      this.places.leave(at);
      this.smooth.leave(at);
      return;
    }
    const [place, smooth] = this.mesh.keysOf(this.mirror.root[node], this.point(node, k));
    this.places.link(at, place);
    this.smooth.link(at, smooth);
    this.reservePoints();
    const here = this.places.pointOf[at];
    if (k < 4 && this.cornersHere[here]++ === 0) this.openOrClose(here);
    this.dirtyPoints.add(this.smooth.pointOf[at], VALUES);
  }

  private unlink(slot: number): void {
    for (let k = 0; k < POINTS; ++k) {
      const at = POINTS * slot + k;
      const place = this.places.pointOf[at];
      if (place < 0) continue;
      this.dirtyPoints.add(this.smooth.pointOf[at], VALUES);
      this.places.unlink(at);
      this.smooth.unlink(at);
      if (k < 4 && --this.cornersHere[place] === 0) this.openOrClose(place);
    }
  }

  /** A corner came to this place, or the last went: middles there change. */
  private openOrClose(place: number): void {
    this.places.forEach(place, (link) => {
      if ((link & 7) < 4) return;
      this.mark(link >> 3, VALUES | POSITIONS);
      this.dirtyPoints.add(this.smooth.pointOf[link], VALUES);
    });
  }

  private isOpen(link: number): boolean {
    return this.places.pointOf[link] >= 0 && this.cornersHere[this.places.pointOf[link]] > 0;
  }

  /** The mean of the leaves around a point, near ones first; those where exactly nothing arrives take no part. */
  private evaluate(point: number): void {
    const sum = [0, 0, 0];
    let weights = 0;
    this.smooth.forEach(point, (link) => {
      const isMiddle = (link & 7) >= 4;
      if (isMiddle && !this.isOpen(link)) return;
      const node = this.nodeOfSlot[link >> 3];
      const [r, g, b] = [0, 1, 2].map((band) => this.mirror.rgb[3 * node + band]);
      if (r === 0 && g === 0 && b === 0) return;
      const side = this.nodeSize[node];
      const weight = (isMiddle ? 2 : 1) / (side * side * this.mesh.area[this.mirror.root[node]]);
      sum[0] += weight * r;
      sum[1] += weight * g;
      sum[2] += weight * b;
      weights += weight;
    });
    for (let band = 0; band < 3; ++band) this.pointValue[3 * point + band] = weights > 0 ? sum[band] / weights : 0;
  }

  /** Which point vertex `v` of the slot (1 to 8) lies in: middles that are not open, and what a triangle has not, in a corner. */
  private pointOfVertex(slot: number, v: number): number {
    const k = v - 1;
    const isTriangle = !this.isQuad(this.nodeOfSlot[slot]);
    if (isTriangle && (k === 3 || k === 7)) return 0;
    if (k < 4) return k;
    return this.isOpen(POINTS * slot + k) ? k : k - 4;
  }

  private writePositions(slot: number, out: Float32Array, at: number): void {
    const node = this.nodeOfSlot[slot];
    const root = this.mirror.root[node];
    this.mesh.position(root, this.centreOf(node), out, at);
    for (let v = 1; v < SLOT_VERTICES; ++v)
      this.mesh.position(root, this.point(node, this.pointOfVertex(slot, v)), out, at + 3 * v);
  }

  private centreOf(node: number): Point {
    const offset = this.nodeSize[node] / (this.isQuad(node) ? 2 : 3);
    return { i: this.nodeI[node] + offset, j: this.nodeJ[node] + offset };
  }

  private writeValues(slot: number, out: Float32Array, at: number): void {
    const node = this.nodeOfSlot[slot];
    const material = this.mesh.material[this.mirror.root[node]];
    for (let v = 0; v < SLOT_VERTICES; ++v) {
      const from = v === 0 ? 3 * node : 3 * this.smooth.pointOf[POINTS * slot + this.pointOfVertex(slot, v)];
      const values = v === 0 ? this.mirror.rgb : this.pointValue;
      for (let band = 0; band < 3; ++band) out[at + 4 * v + band] = values[from + band];
      out[at + 4 * v + 3] = material;
    }
  }

  private mark(slot: number, what: number): void {
    this.dirtySlots.add(slot, what);
  }

  private reserveNodes(count: number): void {
    if (count <= this.nodeI.length) return;
    const room = 2 * count;
    const before = this.slotOfNode.length;
    this.slotOfNode = grown(this.slotOfNode, Int32Array, room).fill(-1, before);
    this.nodeI = grown(this.nodeI, Int32Array, room);
    this.nodeJ = grown(this.nodeJ, Int32Array, room);
    this.nodeSize = grown(this.nodeSize, Int32Array, room);
  }

  private reservePoints(): void {
    if (this.places.count > this.cornersHere.length) this.cornersHere = grown(this.cornersHere, Int32Array, 2 * this.places.count);
    if (3 * this.smooth.count > this.pointValue.length)
      this.pointValue = grown(this.pointValue, Float32Array, 6 * this.smooth.count);
  }
}

/** Which slots meet in which point: of each point a list of links, a link being a slot and which of its eight points lies there. */
class PointTable {
  count = 0;
  /** By link: the point, or -1. */
  pointOf = new Int32Array(POINTS * 1024);
  private next = new Int32Array(POINTS * 1024);
  private previous = new Int32Array(POINTS * 1024);
  private head = new Int32Array(1024);
  private readonly index = new Map<number, number>();

  link(link: number, key: number): void {
    this.reserve(link);
    let point = this.index.get(key);
    if (point === undefined) {
      point = this.count++;
      this.index.set(key, point);
      if (point >= this.head.length) this.head = grown(this.head, Int32Array, 2 * point);
      this.head[point] = -1;
    }
    const after = this.head[point];
    this.pointOf[link] = point;
    this.previous[link] = -1;
    this.next[link] = after;
    if (after >= 0) this.previous[after] = link;
    this.head[point] = link;
  }

  unlink(link: number): void {
    const before = this.previous[link];
    const after = this.next[link];
    if (before >= 0) this.next[before] = after;
    else this.head[this.pointOf[link]] = after;
    if (after >= 0) this.previous[after] = before;
    this.pointOf[link] = -1;
  }

  leave(link: number): void {
    this.reserve(link);
    this.pointOf[link] = -1;
  }

  forEach(point: number, visit: (link: number) => void): void {
    if (point < 0) return;
    for (let link = this.head[point]; link >= 0; link = this.next[link]) visit(link);
  }

  private reserve(link: number): void {
    if (link < this.pointOf.length) return;
    this.pointOf = grown(this.pointOf, Int32Array, 2 * link);
    this.next = grown(this.next, Int32Array, 2 * link);
    this.previous = grown(this.previous, Int32Array, 2 * link);
  }
}

/** Small numbers, each once, with what is to be done about them. */
class DirtySet {
  list: number[] = [];
  flags = new Uint8Array(1024);

  add(member: number, what: number): void {
    if (member < 0) return;
    if (member >= this.flags.length) this.flags = grown(this.flags, Uint8Array, 2 * member);
    if (this.flags[member] === 0) this.list.push(member);
    this.flags[member] |= what;
  }

  clear(): void {
    for (const member of this.list) this.flags[member] = 0;
    this.list = [];
  }
}

const GAP = 8; // unchanged slots between two changed ones that are sent along

function collect(slots: number[], stride: number, write: (slot: number, out: Float32Array, at: number) => void): Change {
  const ranges: number[] = [];
  for (const slot of slots) {
    const last = ranges.length - 2;
    if (last >= 0 && slot - (ranges[last] + ranges[last + 1]) <= GAP) ranges[last + 1] = slot + 1 - ranges[last];
    else ranges.push(slot, 1);
  }
  let total = 0;
  for (let n = 1; n < ranges.length; n += 2) total += ranges[n];
  const data = new Float32Array(total * stride);
  let at = 0;
  for (let n = 0; n < ranges.length; n += 2)
    for (let slot = ranges[n]; slot < ranges[n] + ranges[n + 1]; ++slot, at += stride) write(slot, data, at);
  return { ranges: Uint32Array.from(ranges), data };
}
