// What is drawn of a mirror: for each leaf a slot of nine vertices, its centre, four corners and four middles of edges, and of eight
// triangles around the centre. Middles are drawn where a neighbour has a corner, so that no crack opens. Beside slabs further corners may
// lie on an edge: shading may break there, and so that no crack opens these leaves are drawn over their neighbours a little. Triangles that
// a slot does not need have no area. Only slots that changed are written again.

import type { BaseMesh } from "./base_mesh";
import type { Blend } from "./blend";
import { collect, type Change } from "./change";
import { type Mirror, type MirrorListener, grown } from "./mirror";
import { NodePlaces } from "./node_places";
import { DirtySet, POINTS, PointTable } from "./points";

export const SLOT_VERTICES = 9;
export const SLOT_INDICES = 24;

export interface SurfaceChange {
  slotCount: number;
  /** x, y, z of each vertex, metres from the middle of the mesh. */
  positions: Change;
  /** Texture coordinates s, t of each vertex, of the slots of `positions`; nothing if the mesh has none. */
  coordinates?: Change;
  /** Red, green, blue of each vertex, by which the reflectance is multiplied, of the slots of `positions`; nothing if the mesh has none. */
  colours?: Change;
  /** Irradiance r, g, b, W/m2, and the index of the material. */
  values: Change;
  /** Light of the other side that comes through, r, g, b of each vertex, W/m2; nothing if no root is translucent. */
  transmitted?: Change;
  /** The told error of each vertex's leaf, W/m2; nothing until some were told. */
  errors?: Change;
  /** Three vertices of each triangle; of one without area three times the same. */
  triangles: Change<Uint32Array>;
}

/** Writes the numbers of a point of a root to `out[at]`. */
type WriteMixed = (root: number, blend: Blend, out: Float32Array, at: number) => void;

// Share of its longer side by which a leaf among slabs is drawn over its neighbours. Graphics cards round corners to 1/256 of a pixel, so it
// covers what that opens if the side is four pixels long.
const LAP = 1 / 1024;

const VALUES = 1;
const POSITIONS = 2;
const TRANSMITTED = 4;
const ERRORS = 8;

export class Surface implements MirrorListener {
  private slotCount = 0;
  private nodeOfSlot = new Int32Array(1024); // -1 where a slot is not used
  private readonly unusedSlots: number[] = [];
  private slotOfNode = new Int32Array(1024).fill(-1);
  private readonly places = new PointTable();
  private readonly smooth = new PointTable();
  private cornersHere = new Int32Array(1024); // by place: how many leaves have a corner there
  private pointValue = new Float32Array(3 * 1024); // by smooth point
  private readonly dirtySlots = new DirtySet();
  private readonly dirtyPoints = new DirtySet();
  private readonly nodes = new NodePlaces((node) => this.isQuad(node));
  private mirror!: Mirror;

  constructor(private readonly mesh: BaseMesh) {}

  /** Requires: a mirror of nothing but roots. */
  attach(mirror: Mirror): void {
    this.mirror = mirror;
    for (let root = 0; root < mirror.rootCount; ++root) {
      this.reserveNodes(root + 1);
      this.nodes.placeRoot(root);
      this.newSlot(root);
    }
  }

  onValue(node: number): void {
    this.dirtySlots.add(this.slotOfNode[node], VALUES);
    for (let k = 0; k < POINTS; ++k) this.dirtyPoints.add(this.smooth.pointOf[POINTS * this.slotOfNode[node] + k], VALUES);
  }

  onError(node: number): void {
    this.dirtySlots.add(this.slotOfNode[node], ERRORS);
  }

  onSplit(node: number, first: number, how: number): void {
    this.reserveNodes(first + 4);
    for (let k = 0; k < 4; ++k) this.nodes.placeChild(node, first + k, k, how);
    const slot = this.slotOfNode[node];
    for (let k = 1; k < 4; ++k) this.newSlot(first + k);
    this.unlink(slot);
    this.slotOfNode[node] = -1;
    this.setSlot(slot, first);
  }

  onMerge(node: number, leaves: number[]): void {
    for (const leaf of leaves) {
      const slot = this.slotOfNode[leaf];
      this.unlink(slot);
      this.slotOfNode[leaf] = -1;
      this.nodeOfSlot[slot] = -1;
      this.unusedSlots.push(slot);
      this.dirtySlots.add(slot, POSITIONS);
    }
    this.newSlot(node);
  }

  /** The materials of these roots are other ones. */
  onMaterials(roots: Set<number>): void {
    this.addSlotsOf(roots, VALUES);
  }

  /** These roots lie elsewhere, or were hidden or brought back. */
  onMoved(roots: Set<number>): void {
    this.addSlotsOf(roots, POSITIONS);
  }

  private addSlotsOf(roots: Set<number>, what: number): void {
    for (let slot = 0; roots.size > 0 && slot < this.slotCount; ++slot)
      if (this.isUsed(slot) && roots.has(this.mirror.root[this.nodeOfSlot[slot]])) this.dirtySlots.add(slot, what);
  }

  private isUsed(slot: number): boolean {
    return this.nodeOfSlot[slot] >= 0;
  }

  /** The transmittances of materials are other ones. */
  onTransmittances(): void {
    for (let slot = 0; this.mesh.isTranslucent && slot < this.slotCount; ++slot) this.dirtySlots.add(slot, TRANSMITTED);
  }

  /** What must be drawn anew. */
  flush(): SurfaceChange {
    for (const point of this.dirtyPoints.list) {
      this.evaluate(point);
      for (let link = this.smooth.head[point]; link >= 0; link = this.smooth.next[link]) this.dirtySlots.add(link >> 3, VALUES);
    }
    this.dirtyPoints.clear();
    if (this.mesh.isTranslucent) this.markTransmitted();
    const all = Int32Array.from(this.dirtySlots.list).sort();
    const those = (what: number) => all.filter((slot) => this.dirtySlots.flags[slot] & what);
    const moved = those(POSITIONS);
    const change: SurfaceChange = {
      slotCount: this.slotCount,
      positions: collect(moved, 3 * SLOT_VERTICES, Float32Array, (slot, out, at) => this.writePositions(slot, out, at)),
      coordinates: this.mesh.hasTextures ? this.collectMixed(moved, 2, this.mesh.textureAt.bind(this.mesh)) : undefined,
      colours: this.mesh.hasColours ? this.collectMixed(moved, 3, this.mesh.colourAt.bind(this.mesh)) : undefined,
      values: collect(those(VALUES), 4 * SLOT_VERTICES, Float32Array, (slot, out, at) => this.writeValues(slot, out, at)),
      transmitted: this.mesh.isTranslucent
        ? collect(those(TRANSMITTED), 3 * SLOT_VERTICES, Float32Array, (slot, out, at) => this.writeTransmitted(slot, out, at))
        : undefined,
      errors: this.mirror.hasErrors
        ? collect(those(ERRORS), SLOT_VERTICES, Float32Array, (slot, out, at) =>
            out.fill(this.isUsed(slot) ? this.mirror.errors[this.nodeOfSlot[slot]] : 0, at, at + SLOT_VERTICES),
          )
        : undefined,
      triangles: collect(moved, SLOT_INDICES, Uint32Array, (slot, out, at) => this.writeTriangles(slot, out, at)),
    };
    this.dirtySlots.clear();
    return change;
  }

  /** Where a leaf is new, light comes through to it; where its light changed, to the leaves behind it. */
  private markTransmitted(): void {
    for (const slot of [...this.dirtySlots.list]) {
      if (!this.isUsed(slot)) continue;
      const node = this.nodeOfSlot[slot];
      const other = this.mesh.otherSideOf(this.mirror.root[node]);
      if (other < 0) continue;
      if (this.dirtySlots.flags[slot] & POSITIONS) this.dirtySlots.add(slot, TRANSMITTED);
      const behind = this.mirror.nodeBehind(node, other);
      if (this.slotOfNode[behind] >= 0) this.dirtySlots.add(this.slotOfNode[behind], TRANSMITTED);
      else for (const leaf of this.mirror.leavesUnder(behind)) this.dirtySlots.add(this.slotOfNode[leaf], TRANSMITTED);
    }
  }

  private isQuad(node: number): boolean {
    return this.mesh.cornersOf(this.mirror.root[node]) === 4;
  }

  private newSlot(node: number): void {
    const slot = this.unusedSlots.pop() ?? this.slotCount++;
    if (slot >= this.nodeOfSlot.length) this.nodeOfSlot = grown(this.nodeOfSlot, Int32Array, 2 * slot);
    this.setSlot(slot, node);
  }

  private setSlot(slot: number, node: number): void {
    this.nodeOfSlot[slot] = node;
    this.slotOfNode[node] = slot;
    for (let k = 0; k < POINTS; ++k) this.link(slot, k);
    this.dirtySlots.add(slot, VALUES | POSITIONS | ERRORS | (this.mesh.isTranslucent ? TRANSMITTED : 0));
  }

  private link(slot: number, k: number): void {
    const node = this.nodeOfSlot[slot];
    const at = POINTS * slot + k;
    if (!this.nodes.hasPoint(node, k)) {
      this.places.leave(at);
      this.smooth.leave(at);
      return;
    }
    this.nodes.findPoint(node, k);
    const root = this.mirror.root[node];
    const place = this.mesh.placeKey(root, this.nodes.pointI, this.nodes.pointJ);
    this.places.link(at, place);
    this.smooth.link(at, this.mesh.smoothKey(root, this.nodes.pointI, this.nodes.pointJ, place));
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
    for (let link = this.places.head[place]; link >= 0; link = this.places.next[link]) {
      if ((link & 7) < 4) continue;
      this.dirtySlots.add(link >> 3, VALUES | POSITIONS);
      this.dirtyPoints.add(this.smooth.pointOf[link], VALUES);
    }
  }

  private isOpen(link: number): boolean {
    return this.places.pointOf[link] >= 0 && this.cornersHere[this.places.pointOf[link]] > 0;
  }

  /** The mean of the leaves around a point, near ones first; those where exactly nothing arrives take no part. */
  private evaluate(point: number): void {
    const { rgb, root } = this.mirror;
    const { next } = this.smooth;
    let r = 0;
    let g = 0;
    let b = 0;
    let weights = 0;
    for (let link = this.smooth.head[point]; link >= 0; link = next[link]) {
      const isMiddle = (link & 7) >= 4;
      if (isMiddle && !this.isOpen(link)) continue;
      const node = this.nodeOfSlot[link >> 3];
      const at = 3 * node;
      if (rgb[at] === 0 && rgb[at + 1] === 0 && rgb[at + 2] === 0) continue;
      const weight = (isMiddle ? 2 : 1) / (this.nodes.area(node) * this.mesh.area[root[node]]);
      r += weight * rgb[at];
      g += weight * rgb[at + 1];
      b += weight * rgb[at + 2];
      weights += weight;
    }
    const scale = weights > 0 ? 1 / weights : 0;
    this.pointValue[3 * point] = scale * r;
    this.pointValue[3 * point + 1] = scale * g;
    this.pointValue[3 * point + 2] = scale * b;
  }

  // Unused slots keep zeros, and have triangles without area.

  private writePositions(slot: number, out: Float32Array, at: number): void {
    if (!this.isUsed(slot)) return;
    const node = this.nodeOfSlot[slot];
    const root = this.mirror.root[node];
    const [i, j] = this.nodes.middle(node);
    this.mesh.position(root, i, j, out, at);
    const lap = this.lapOf(node);
    for (let k = 0; k < POINTS; ++k) {
      this.nodes.findPoint(node, k);
      const [u, v] = [this.nodes.pointI + lap * Math.sign(this.nodes.pointI - i), this.nodes.pointJ + lap * Math.sign(this.nodes.pointJ - j)];
      this.mesh.position(root, u, v, out, at + 3 * (k + 1));
    }
  }

  /** How far a leaf is drawn over its neighbours, in grid steps: leaves among slabs a little, because their corners may lie on longer edges. */
  private lapOf(node: number): number {
    return this.mirror.isAmongSlabs(node) ? LAP * this.nodes.longerSide(node) : 0;
  }

  /** Returns `count` numbers of each vertex of `slots`, which `write` mixes from those of the root's corners. */
  private collectMixed(slots: Int32Array, count: number, write: WriteMixed): Change {
    return collect(slots, count * SLOT_VERTICES, Float32Array, (slot, out, at) => {
      if (!this.isUsed(slot)) return;
      const node = this.nodeOfSlot[slot];
      const root = this.mirror.root[node];
      write(root, this.mesh.blendAt(root, ...this.nodes.middle(node)), out, at);
      for (let k = 0; k < POINTS; ++k) {
        this.nodes.findPoint(node, k);
        write(root, this.mesh.blendAt(root, this.nodes.pointI, this.nodes.pointJ), out, at + count * (k + 1));
      }
    });
  }

  private writeValues(slot: number, out: Float32Array, at: number): void {
    if (!this.isUsed(slot)) return;
    const node = this.nodeOfSlot[slot];
    const material = this.mesh.material[this.mirror.root[node]];
    const { pointOf } = this.smooth;
    for (let v = 0; v < SLOT_VERTICES; ++v, at += 4) {
      const point = v === 0 ? -1 : pointOf[POINTS * slot + v - 1];
      const values = point < 0 ? this.mirror.rgb : this.pointValue;
      const from = point < 0 ? 3 * node : 3 * point;
      out[at] = values[from];
      out[at + 1] = values[from + 1];
      out[at + 2] = values[from + 2];
      out[at + 3] = material;
    }
  }

  /** Leaves of roots that are not translucent keep their zeros. */
  private writeTransmitted(slot: number, out: Float32Array, at: number): void {
    if (!this.isUsed(slot)) return;
    const node = this.nodeOfSlot[slot];
    const root = this.mirror.root[node];
    const other = this.mesh.otherSideOf(root);
    if (other < 0) return;
    const { r, g, b } = this.mesh.transmittanceOf(root);
    const behind = this.mirror.nodeBehind(node, other);
    const mean = this.mirror.meanIrradiance(behind);
    const isCoarser = this.mirror.levelOf(behind) < this.mirror.levelOf(node);
    for (let v = 0; v < SLOT_VERTICES; ++v, at += 3) {
      const point = v === 0 || isCoarser ? -1 : this.pointBehind(node, v - 1, behind, other);
      const values = point < 0 ? mean : this.pointValue;
      const from = point < 0 ? 0 : 3 * point;
      out[at] = r * values[from];
      out[at + 1] = g * values[from + 1];
      out[at + 2] = b * values[from + 2];
    }
  }

  /** Returns the smooth point in the same place on the other side; -1 if no leaf there has a corner in that place. */
  private pointBehind(node: number, k: number, behind: number, other: number): number {
    if (!this.nodes.hasPoint(node, k)) return -1;
    const slot = this.slotOfNode[behind];
    if (slot < 0) return this.pointOfSmallerBehind(node, k, other);
    const corners = this.isQuad(node) ? 4 : 3;
    const link = POINTS * slot + (k < 4 ? (corners - k) % corners : 4 + corners - 1 - (k - 4));
    return this.isOpen(link) ? this.smooth.pointOf[link] : -1;
  }

  /** As pointBehind, where leaves there are smaller: none of them has all points of `node`. */
  private pointOfSmallerBehind(node: number, k: number, other: number): number {
    this.nodes.findPoint(node, k);
    const key = this.mesh.placeKey(other, this.nodes.pointJ, this.nodes.pointI);
    const place = this.places.find(key);
    if (place < 0 || this.cornersHere[place] === 0) return -1;
    const point = this.smooth.find(this.mesh.smoothKey(other, this.nodes.pointJ, this.nodes.pointI, key));
    return point >= 0 && this.smooth.head[point] >= 0 ? point : -1;
  }

  private writeTriangles(slot: number, out: Uint32Array, at: number): void {
    const centre = SLOT_VERTICES * slot;
    out.fill(centre, at, at + SLOT_INDICES);
    if (!this.isUsed(slot)) return;
    const corners = this.isQuad(this.nodeOfSlot[slot]) ? 4 : 3;
    if (this.mesh.isHidden(this.mirror.root[this.nodeOfSlot[slot]])) return;
    for (let k = 0; k < corners; ++k, at += 6) {
      const next = centre + 1 + ((k + 1) % corners);
      const isOpen = this.isOpen(POINTS * slot + 4 + k);
      out[at + 1] = centre + 1 + k;
      out[at + 2] = isOpen ? centre + 5 + k : next;
      if (!isOpen) continue;
      out[at + 4] = centre + 5 + k;
      out[at + 5] = next;
    }
  }

  private reserveNodes(count: number): void {
    this.nodes.reserve(count);
    if (count <= this.slotOfNode.length) return;
    this.slotOfNode = grown(this.slotOfNode, Int32Array, 2 * count).fill(-1, this.slotOfNode.length);
  }

  private reservePoints(): void {
    if (this.places.count > this.cornersHere.length) this.cornersHere = grown(this.cornersHere, Int32Array, 2 * this.places.count);
    if (3 * this.smooth.count > this.pointValue.length)
      this.pointValue = grown(this.pointValue, Float32Array, 6 * this.smooth.count);
  }
}
