// Computes where each patch that a viewer holds lies, and how long its sides are, as whole numbers on a grid over its root patch.

import { GRID, grown } from "./mirror";
import { QUARTERS, SLABS_ALONG_U } from "./patch_id";

const QUAD_COLUMNS = [0, 1, 1, 0];
const QUAD_ROWS = [0, 0, 1, 1];
const TRIANGLE_COLUMNS = [0, 1, 0];
const TRIANGLE_ROWS = [0, 0, 1];

/** Places and sizes of nodes, in steps of the finest grid of a root: u = i / GRID and v = j / GRID. */
export class NodePlaces {
  /** The point that findPoint() found. */
  pointI = 0;
  pointJ = 0;
  // By node: where its corner 0 lies, and how long its sides along u and v are. A triangle that is turned by half a circle against its root
  // has negative sides.
  private cornerI = new Int32Array(1024);
  private cornerJ = new Int32Array(1024);
  private sizeU = new Int32Array(1024);
  private sizeV = new Int32Array(1024);

  constructor(private readonly isQuad: (node: number) => boolean) {}

  placeRoot(node: number): void {
    this.sizeU[node] = this.sizeV[node] = GRID;
  }

  /** Gives child `k` of a node that is split so (patch_id.ts) its place. */
  placeChild(parent: number, child: number, k: number, how: number): void {
    if (how === QUARTERS) {
      const inner = k === 3 && !this.isQuad(parent);
      const column = this.isQuad(parent) ? k & 1 : Number(k === 1 || inner);
      const row = this.isQuad(parent) ? k >> 1 : Number(k === 2 || inner);
      this.placeIn(parent, child, column, row, 2, 2);
      if (!inner) return;
      this.sizeU[child] *= -1;
      this.sizeV[child] *= -1;
    } else if (how === SLABS_ALONG_U) {
      this.placeIn(parent, child, k, 0, 4, 1);
    } else {
      this.placeIn(parent, child, 0, k, 1, 4);
    }
  }

  /** Gives a node its place in the column and row of its parent, which has so many of them. */
  private placeIn(parent: number, child: number, column: number, row: number, columns: number, rows: number): void {
    this.sizeU[child] = this.sizeU[parent] / columns;
    this.sizeV[child] = this.sizeV[parent] / rows;
    this.cornerI[child] = this.cornerI[parent] + column * this.sizeU[child];
    this.cornerJ[child] = this.cornerJ[parent] + row * this.sizeV[child];
  }

  /** Sets pointI and pointJ. Points 0 to 3 are the corners, 4 to 7 the middles of the edges that begin at them. */
  findPoint(node: number, k: number): void {
    const last = this.isQuad(node) ? 4 : 3;
    const columns = last === 4 ? QUAD_COLUMNS : TRIANGLE_COLUMNS;
    const rows = last === 4 ? QUAD_ROWS : TRIANGLE_ROWS;
    const a = (k & 3) % last;
    const b = k < 4 ? a : (a + 1) % last;
    this.pointI = this.cornerI[node] + ((columns[a] + columns[b]) * this.sizeU[node]) / 2;
    this.pointJ = this.cornerJ[node] + ((rows[a] + rows[b]) * this.sizeV[node]) / 2;
  }

  /** A triangle's last corner and edge are none, and edges as short as the finest grid's have no middle. */
  hasPoint(node: number, k: number): boolean {
    if ((k === 3 || k === 7) && !this.isQuad(node)) return false;
    // Edges 0 and 2 of a quad lie along u; the sizes of a triangle are alike.
    return k < 4 || Math.abs(k % 2 === 0 ? this.sizeU[node] : this.sizeV[node]) > 1;
  }

  /** The middle of a quad, the centroid of a triangle. */
  middle(node: number): [number, number] {
    const parts = this.isQuad(node) ? 2 : 3;
    return [this.cornerI[node] + this.sizeU[node] / parts, this.cornerJ[node] + this.sizeV[node] / parts];
  }

  longerSide(node: number): number {
    return Math.max(this.sizeU[node], this.sizeV[node]);
  }

  /** Of a quad, twice that of a triangle. */
  area(node: number): number {
    return this.sizeU[node] * this.sizeV[node];
  }

  reserve(count: number): void {
    if (count <= this.cornerI.length) return;
    this.cornerI = grown(this.cornerI, Int32Array, 2 * count);
    this.cornerJ = grown(this.cornerJ, Int32Array, 2 * count);
    this.sizeU = grown(this.sizeU, Int32Array, 2 * count);
    this.sizeV = grown(this.sizeV, Int32Array, 2 * count);
  }
}
