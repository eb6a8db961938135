// The other end of the stream: a quadtree of leaves for each root patch, built from frames. The same as SolutionMirror of C++.

import type { ErrorPage } from "./errors";
import { BadFrame, type Leaves } from "./leaves";
import {
  childIndex,
  FACE_BITS,
  levelOf,
  MAX_LEVEL,
  mirrored,
  mirroredSplit,
  QUARTERS,
  SLABS_ALONG_U,
  slabsOfChildren,
  splitAbove,
} from "./patch_id";
import { StateHash } from "./state_hash";

/** Side of a root patch on the finest grid. */
export const GRID = 1 << MAX_LEVEL;

const UNUSED = -1;

/** A leaf that something was said about. */
export interface ToldLeaf {
  face: number;
  path: number;
  slabs: number;
  rgb: [number, number, number];
}

/** Told of what changes, in order. */
export interface MirrorListener {
  /** A leaf became four; `first` is the first of them, and `how` is QUARTERS, SLABS_ALONG_U or SLABS_ALONG_V. */
  onSplit(node: number, first: number, how: number): void;
  /** `leaves`, all under a node, become one, the node; then the nodes under it are used for others. */
  onMerge(node: number, leaves: number[]): void;
  onValue(node: number): void;
  onError?(node: number): void;
}

/** Roots come first, in the order of the mesh; the four children of a node are neighbours. */
export class Mirror {
  /** Of each node: its first child, 0 for a leaf, or UNUSED. */
  firstChild: Int32Array;
  root: Uint32Array;
  /** Irradiance of leaves, W/m2, three of each node. */
  rgb: Float32Array;
  /** Told errors of leaves, W/m2: one standard deviation of the mean of the bands. */
  errors: Float32Array;
  /** Some errors were told. */
  hasErrors = false;
  nodeCount: number;
  leafCount = 0;
  private path: Uint32Array;
  private slabs: Uint16Array;
  /** Of each node that is no leaf: how it is split. */
  private howSplit: Uint8Array;
  private known: Uint8Array;
  private hash = new StateHash();
  /** The first of each four nodes that are not used. */
  private readonly unused: number[] = [];

  constructor(
    readonly rootCount: number,
    private readonly listener?: MirrorListener,
    /** Whether a root is a triangle, which has no slabs. */
    private readonly isTriangle: (root: number) => boolean = () => false,
  ) {
    const room = Math.max(64, 2 * rootCount);
    this.firstChild = new Int32Array(room);
    this.root = new Uint32Array(room);
    this.path = new Uint32Array(room);
    this.slabs = new Uint16Array(room);
    this.howSplit = new Uint8Array(room);
    this.rgb = new Float32Array(3 * room);
    this.errors = new Float32Array(room);
    this.known = new Uint8Array(rootCount);
    this.nodeCount = rootCount;
    for (let n = 0; n < rootCount; ++n) {
      this.root[n] = n;
      this.path[n] = 2 ** 30;
    }
  }

  /** Of all leaves that something was said about: two halves, as the server's frames have it. */
  get stateHash(): bigint {
    return this.hash.bits;
  }

  /** Of its root's area. */
  shareOf(node: number): number {
    const path = this.path[node];
    return (path & -path) / 2 ** 30;
  }

  /** Whether an ancestor of the node was split into slabs. */
  isAmongSlabs(node: number): boolean {
    return this.slabs[node] !== 0;
  }

  levelOf(node: number): number {
    return levelOf(this.path[node]);
  }

  /** Whole or, where it throws BadFrame, not at all. */
  apply(leaves: Leaves): void {
    for (let n = 0; n < leaves.count; ++n) {
      const root = leaves.face[n];
      if (root >= this.rootCount) throw new BadFrame(`root patch ${root} is not in the mesh`);
      if (leaves.slabs[n] !== 0 && this.isTriangle(root)) throw new BadFrame(`root patch ${root} is a triangle, and has slabs`);
    }
    for (let n = 0; n < leaves.count; ++n) this.setLeaf(leaves.face[n], leaves.path[n], leaves.slabs[n], leaves.rgb, 3 * n);
  }

  /** Takes the leaves and errors of a mirror that has fewer roots. Requires: newly made. */
  takeAll(other: Mirror): void {
    for (let root = 0; root < other.rootCount; ++root) if (other.known[root]) this.copy(other, root);
    this.hasErrors = other.hasErrors;
  }

  private copy(other: Mirror, root: number): void {
    for (const leaf of other.leavesUnder(root)) {
      const node = this.setLeaf(root, other.path[leaf], other.slabs[leaf], other.rgb, 3 * leaf);
      this.errors[node] = other.errors[leaf];
      this.listener?.onError?.(node);
    }
  }

  /** Gives the leaf of this id the irradiance rgb[at], rgb[at + 1], rgb[at + 2], and returns it. */
  private setLeaf(face: number, path: number, slabs: number, rgb: Float32Array, at: number): number {
    const node = this.grow(face, path, slabs);
    this.removeFromHash(node);
    for (let band = 0; band < 3; ++band) this.rgb[3 * node + band] = rgb[at + band];
    this.addToHash(node);
    this.listener?.onValue(node);
    return node;
  }

  private addToHash(node: number): void {
    this.hash.add(this.upperHalfOfId(node), this.path[node], this.rgb, 3 * node);
  }

  private removeFromHash(node: number): void {
    this.hash.remove(this.upperHalfOfId(node), this.path[node], this.rgb, 3 * node);
  }

  private upperHalfOfId(node: number): number {
    return (this.slabs[node] << FACE_BITS) | this.root[node];
  }

  /** Requires: the mirror is a state of the solve. Throws BadFrame if there are no such leaves. */
  takeErrors({ face, path, slabs, errors }: ErrorPage): void {
    this.hasErrors = true;
    let at = -1; // before the first of them
    for (let root = face; root < this.rootCount && at < errors.length; ++root) {
      if (!this.known[root]) continue;
      for (const node of this.leavesUnder(root)) {
        if (at < 0 && root === face && this.path[node] === path && this.slabs[node] === slabs) at = 0;
        if (at < 0) continue;
        if (at === errors.length) return;
        this.errors[node] = errors[at++];
        this.listener?.onError?.(node);
      }
      if (at < 0) break;
    }
    if (at !== errors.length) throw new BadFrame("a frame tells errors of leaves that are not there");
  }

  /** The leaf that contains a place of a root: coordinates of the finest patches of its quadtree path. */
  leafAt(root: number, path: number): number {
    let node = root;
    // Levels of the path whose half of u, and of v, was taken.
    let levelU = 0;
    let levelV = 0;
    const halfOfU = () => childIndex(path, ++levelU) & 1;
    const halfOfV = () => childIndex(path, ++levelV) >> 1;
    while (this.firstChild[node] !== 0) {
      const how = this.howSplit[node];
      const k = how === QUARTERS ? halfOfU() + 2 * halfOfV() : how === SLABS_ALONG_U ? 2 * halfOfU() + halfOfU() : 2 * halfOfV() + halfOfV();
      node = this.firstChild[node] + k;
    }
    return node;
  }

  /**
   * The node in the same place behind a node, on a root whose (u, v) is its root's (v, u); if there is none, the leaf around it, or the node
   * around it that is split in another way, as it can be until all frames of a step have come.
   */
  nodeBehind(node: number, root: number): number {
    const slabs = this.slabs[node];
    const path = mirrored(this.path[node], slabs);
    let behind = root;
    const end = levelOf(path);
    for (let level = 1; level <= end && this.firstChild[behind] !== 0; ++level) {
      if (this.howSplit[behind] !== mirroredSplit(splitAbove(slabs, level))) break;
      behind = this.firstChild[behind] + childIndex(path, level);
    }
    return behind;
  }

  /** A leaf, or all leaves that a node was split into. */
  *leavesUnder(node: number): Generator<number> {
    const first = this.firstChild[node];
    if (first === 0) yield node;
    else for (let k = 0; k < 4; ++k) yield* this.leavesUnder(first + k);
  }

  /** Of the leaves under a node, W/m2; their areas count by their sizes on the grid. */
  meanIrradiance(node: number): [number, number, number] {
    if (this.firstChild[node] === 0) return [this.rgb[3 * node], this.rgb[3 * node + 1], this.rgb[3 * node + 2]];
    const mean: [number, number, number] = [0, 0, 0];
    for (const leaf of this.leavesUnder(node)) {
      const share = 4 ** (this.levelOf(node) - this.levelOf(leaf));
      for (let band = 0; band < 3; ++band) mean[band] += share * this.rgb[3 * leaf + band];
    }
    return mean;
  }

  /** All leaves that something was said about, in the order of their faces and paths. */
  *leaves(): Generator<ToldLeaf> {
    for (let root = 0; root < this.rootCount; ++root) if (this.known[root]) yield* this.leavesOf(root);
  }

  private *leavesOf(node: number): Generator<ToldLeaf> {
    const first = this.firstChild[node];
    if (first === 0) {
      const at = 3 * node;
      const rgb: [number, number, number] = [this.rgb[at], this.rgb[at + 1], this.rgb[at + 2]];
      yield { face: this.root[node], path: this.path[node], slabs: this.slabs[node], rgb };
    } else {
      for (let k = 0; k < 4; ++k) yield* this.leavesOf(first + k);
    }
  }

  /**
   * The leaf of this id, splitting down to it, siblings inherit, or making those within it one. A node that is split in another way than
   * the id says, as after a solve began anew, becomes one leaf first.
   */
  private grow(face: number, path: number, slabs: number): number {
    const level = levelOf(path);
    if (!this.known[face]) {
      this.known[face] = 1;
      this.leafCount += 1;
      this.addToHash(face);
    }
    let node = face;
    for (let l = 1; l <= level; ++l) {
      const how = splitAbove(slabs, l);
      if (this.firstChild[node] !== 0 && this.howSplit[node] !== how) this.merge(node);
      if (this.firstChild[node] === 0) this.split(node, l, how);
      node = this.firstChild[node] + childIndex(path, l);
    }
    if (this.firstChild[node] !== 0) this.merge(node);
    return node;
  }

  private merge(node: number): void {
    const leaves = [...this.leavesUnder(node)];
    for (const leaf of leaves) this.removeFromHash(leaf);
    this.rgb.copyWithin(3 * node, 3 * leaves[0], 3 * leaves[0] + 3);
    this.errors[node] = this.errors[leaves[0]];
    this.addToHash(node);
    this.leafCount -= leaves.length - 1;
    this.listener?.onMerge(node, leaves);
    this.release(node);
  }

  /** Makes a node a leaf. */
  private release(node: number): void {
    const first = this.firstChild[node];
    if (first === 0) return;
    for (let k = 0; k < 4; ++k) {
      this.release(first + k);
      this.firstChild[first + k] = UNUSED;
    }
    this.unused.push(first);
    this.firstChild[node] = 0;
  }

  private split(node: number, childLevel: number, how: number): void {
    const first = this.unused.pop() ?? this.newNodes();
    this.leafCount += 3;
    this.firstChild[node] = first;
    this.howSplit[node] = how;
    const half = 4 ** (MAX_LEVEL - childLevel);
    const slabs = slabsOfChildren(this.slabs[node], childLevel - 1, how);
    this.removeFromHash(node);
    for (let k = 0; k < 4; ++k) {
      const child = first + k;
      this.firstChild[child] = 0;
      this.root[child] = this.root[node];
      this.path[child] = this.path[node] - 4 * half + (2 * k + 1) * half;
      this.slabs[child] = slabs;
      this.rgb.copyWithin(3 * child, 3 * node, 3 * node + 3);
      this.errors[child] = this.errors[node];
      this.addToHash(child);
    }
    this.listener?.onSplit(node, first, how);
  }

  /** The first of four. */
  private newNodes(): number {
    this.reserve(this.nodeCount + 4);
    this.nodeCount += 4;
    return this.nodeCount - 4;
  }

  private reserve(count: number): void {
    if (count <= this.firstChild.length) return;
    const room = Math.max(count, Math.ceil(1.5 * this.firstChild.length));
    this.firstChild = grown(this.firstChild, Int32Array, room);
    this.root = grown(this.root, Uint32Array, room);
    this.path = grown(this.path, Uint32Array, room);
    this.slabs = grown(this.slabs, Uint16Array, room);
    this.howSplit = grown(this.howSplit, Uint8Array, room);
    this.rgb = grown(this.rgb, Float32Array, 3 * room);
    this.errors = grown(this.errors, Float32Array, room);
  }
}

export function grown<T extends Int32Array | Uint32Array | Float32Array | Uint8Array | Uint16Array>(
  old: T,
  Kind: new (length: number) => T,
  room: number,
): T {
  const larger = new Kind(room);
  larger.set(old as never);
  return larger;
}
