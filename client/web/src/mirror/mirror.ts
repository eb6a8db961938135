// The other end of the stream: a quadtree of leaves for each root patch, built from frames. The same as SolutionMirror of C++.

import type { ErrorPage } from "./errors";
import { BadFrame, levelOf, MAX_LEVEL, type Leaves } from "./leaves";
import { StateHash } from "./state_hash";

/** Side of a root patch on the finest grid. */
export const GRID = 1 << MAX_LEVEL;

const UNUSED = -1;

/** Told of what changes, in order. */
export interface MirrorListener {
  /** A leaf became four; `first` is the first of them. */
  onSplit(node: number, first: number): void;
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
  private known: Uint8Array;
  private hash = new StateHash();
  /** The first of each four nodes that are not used. */
  private readonly unused: number[] = [];

  constructor(
    readonly rootCount: number,
    private readonly listener?: MirrorListener,
  ) {
    const room = Math.max(64, 2 * rootCount);
    this.firstChild = new Int32Array(room);
    this.root = new Uint32Array(room);
    this.path = new Uint32Array(room);
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

  levelOf(node: number): number {
    return levelOf(this.path[node]);
  }

  /** Whole or, where it throws BadFrame, not at all. */
  apply(leaves: Leaves): void {
    for (let n = 0; n < leaves.count; ++n)
      if (leaves.face[n] >= this.rootCount) throw new BadFrame(`root patch ${leaves.face[n]} is not in the mesh`);
    for (let n = 0; n < leaves.count; ++n) this.setLeaf(leaves.face[n], leaves.path[n], leaves.rgb, 3 * n);
  }

  /** Takes the leaves and errors of a mirror that has fewer roots. Requires: newly made. */
  takeAll(other: Mirror): void {
    for (let root = 0; root < other.rootCount; ++root) if (other.known[root]) this.copy(other, root);
    this.hasErrors = other.hasErrors;
  }

  private copy(other: Mirror, root: number): void {
    for (const leaf of other.leavesUnder(root)) {
      const node = this.setLeaf(root, other.path[leaf], other.rgb, 3 * leaf);
      this.errors[node] = other.errors[leaf];
      this.listener?.onError?.(node);
    }
  }

  /** Gives the leaf of this id the irradiance rgb[at], rgb[at + 1], rgb[at + 2], and returns it. */
  private setLeaf(face: number, path: number, rgb: Float32Array, at: number): number {
    const node = this.grow(face, path);
    this.hash.remove(face, path, this.rgb, 3 * node);
    for (let band = 0; band < 3; ++band) this.rgb[3 * node + band] = rgb[at + band];
    this.hash.add(face, path, this.rgb, 3 * node);
    this.listener?.onValue(node);
    return node;
  }

  /** Requires: the mirror is a state of the solve. Throws BadFrame if there are no such leaves. */
  takeErrors({ face, path, errors }: ErrorPage): void {
    this.hasErrors = true;
    let at = -1; // before the first of them
    for (let root = face; root < this.rootCount && at < errors.length; ++root) {
      if (!this.known[root]) continue;
      for (const node of this.leavesUnder(root)) {
        if (at < 0 && root === face && this.path[node] === path) at = 0;
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
    for (let level = 1; this.firstChild[node] !== 0; ++level) node = this.firstChild[node] + childIndex(path, level);
    return node;
  }

  /** The node of the same size that lies behind a node, on a root whose (u, v) is its root's (v, u); if there is none, the leaf around it. */
  nodeBehind(node: number, root: number): number {
    const path = mirrored(this.path[node]);
    let behind = root;
    const end = levelOf(path);
    for (let level = 1; level <= end && this.firstChild[behind] !== 0; ++level)
      behind = this.firstChild[behind] + childIndex(path, level);
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

  /** All leaves that something was said about, in the order of their ids. */
  *leaves(): Generator<{ face: number; path: number; rgb: [number, number, number] }> {
    for (let root = 0; root < this.rootCount; ++root) if (this.known[root]) yield* this.leavesOf(root);
  }

  private *leavesOf(node: number): Generator<{ face: number; path: number; rgb: [number, number, number] }> {
    const first = this.firstChild[node];
    if (first === 0) {
      const at = 3 * node;
      yield { face: this.root[node], path: this.path[node], rgb: [this.rgb[at], this.rgb[at + 1], this.rgb[at + 2]] };
    } else {
      for (let k = 0; k < 4; ++k) yield* this.leavesOf(first + k);
    }
  }

  /** The leaf of this id, splitting down to it, siblings inherit, or making those within it one. */
  private grow(face: number, path: number): number {
    const level = levelOf(path);
    if (!this.known[face]) {
      this.known[face] = 1;
      this.leafCount += 1;
      this.hash.add(face, this.path[face], this.rgb, 3 * face);
    }
    let node = face;
    for (let l = 1; l <= level; ++l) {
      if (this.firstChild[node] === 0) this.split(node, l);
      node = this.firstChild[node] + childIndex(path, l);
    }
    if (this.firstChild[node] !== 0) this.merge(node);
    return node;
  }

  private merge(node: number): void {
    const leaves = [...this.leavesUnder(node)];
    for (const leaf of leaves) this.hash.remove(this.root[leaf], this.path[leaf], this.rgb, 3 * leaf);
    this.rgb.copyWithin(3 * node, 3 * leaves[0], 3 * leaves[0] + 3);
    this.errors[node] = this.errors[leaves[0]];
    this.hash.add(this.root[node], this.path[node], this.rgb, 3 * node);
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

  private split(node: number, childLevel: number): void {
    const first = this.unused.pop() ?? this.newNodes();
    this.leafCount += 3;
    this.firstChild[node] = first;
    const half = 4 ** (MAX_LEVEL - childLevel);
    this.hash.remove(this.root[node], this.path[node], this.rgb, 3 * node);
    for (let k = 0; k < 4; ++k) {
      const child = first + k;
      this.firstChild[child] = 0;
      this.root[child] = this.root[node];
      this.path[child] = this.path[node] - 4 * half + (2 * k + 1) * half;
      this.rgb.copyWithin(3 * child, 3 * node, 3 * node + 3);
      this.errors[child] = this.errors[node];
      this.hash.add(this.root[child], this.path[child], this.rgb, 3 * child);
    }
    this.listener?.onSplit(node, first);
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
    this.rgb = grown(this.rgb, Float32Array, 3 * room);
    this.errors = grown(this.errors, Float32Array, room);
  }
}

/** Which child of its ancestor at `level` - 1 contains the patch of this path. */
export function childIndex(path: number, level: number): number {
  return (path >>> (2 * (MAX_LEVEL - level) + 1)) & 3;
}

/** Returns the path of the patch in the same place of a root whose (u, v) is this one's (v, u): children 1 and 2 change places. */
export function mirrored(path: number): number {
  const end = path & -path;
  const children = (path - end) >>> 1;
  return 2 * (((children & 0x15555555) << 1) | ((children >>> 1) & 0x15555555)) + end;
}

export function grown<T extends Int32Array | Uint32Array | Float32Array | Uint8Array>(
  old: T,
  Kind: new (length: number) => T,
  room: number,
): T {
  const larger = new Kind(room);
  larger.set(old as never);
  return larger;
}
