// Where the slots of a surface meet.

import { grown } from "./mirror";

/** Of a slot: four corners, and the middles of the edges that begin at them. */
export const POINTS = 8;

/** Which slots meet in which point: of each point a list of links, a link being a slot and which of its eight points lies there. */
export class PointTable {
  count = 0;
  /** By link: the point, or -1. */
  pointOf = new Int32Array(POINTS * 1024);
  /** Of a point its first link, of a link the one after it, or -1. */
  head = new Int32Array(1024);
  next = new Int32Array(POINTS * 1024);
  private previous = new Int32Array(POINTS * 1024);
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

  /** Returns the point of this key, or -1. */
  find(key: number): number {
    return this.index.get(key) ?? -1;
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

  private reserve(link: number): void {
    if (link < this.pointOf.length) return;
    this.pointOf = grown(this.pointOf, Int32Array, 2 * link);
    this.next = grown(this.next, Int32Array, 2 * link);
    this.previous = grown(this.previous, Int32Array, 2 * link);
  }
}

/** Small numbers, each once, with what is to be done about them. */
export class DirtySet {
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
