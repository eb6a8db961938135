// The numbers of a patch's id: solution/patch_id.h. The lower half of an id is the path from the root. The upper half is the root in
// 22 bits and above them the slab code in 10 bits, which tells which ancestors were split into slabs.

export const MAX_LEVEL = 15;
export const FACE_BITS = 22;

/** How a patch is split into four: into quarters, or a quad into slabs side by side along u or along v. */
export const QUARTERS = 0;
export const SLABS_ALONG_U = 1;
export const SLABS_ALONG_V = 2;

/** Returns the level of a path: 15 is the finest. */
export function levelOf(path: number): number {
  return MAX_LEVEL - (31 - Math.clz32(path & -path)) / 2;
}

/** Returns which child of its ancestor at `level` - 1 contains the patch of this path. */
export function childIndex(path: number, level: number): number {
  return (path >>> (2 * (MAX_LEVEL - level) + 1)) & 3;
}

/** Returns the level of the smallest patch that contains two patches of one root. Requires: they are disjoint. */
export function commonLevel(a: number, b: number): number {
  const begin = (path: number) => path - (path & -path) + 1;
  return (Math.clz32(begin(a) ^ begin(b)) - 1) >> 1;
}

// The lower five bits of a slab code tell of the first ancestor that was split into slabs, the upper five of the second: 0 if there is
// none, else 1 + 2 level + axis, where `level` is that of the ancestor.
const levelOfSlabs = (five: number) => (five - 1) >> 1;
const splitOfSlabs = (five: number) => (five & 1 ? SLABS_ALONG_U : SLABS_ALONG_V);

/** Returns how the ancestor at `level` - 1 is split. */
export function splitAbove(slabs: number, level: number): number {
  for (let fives = slabs; fives !== 0; fives >>= 5)
    if (levelOfSlabs(fives & 31) === level - 1) return splitOfSlabs(fives & 31);
  return QUARTERS;
}

/** Returns the slab code of the children of a patch of this code and level. */
export function slabsOfChildren(slabs: number, level: number, how: number): number {
  if (how === QUARTERS) return slabs;
  const five = 2 * level + how;
  return slabs === 0 ? five : slabs | (five << 5);
}

/** Returns the slab code of the ancestor at `level`. */
export function slabsOfAncestor(slabs: number, level: number): number {
  if (slabs === 0 || levelOfSlabs(slabs & 31) >= level) return 0;
  return slabs >> 5 === 0 || levelOfSlabs(slabs >> 5) >= level ? slabs & 31 : slabs;
}

/** Returns whether a patch of this level can have this slab code. */
export function areValidSlabs(slabs: number, level: number): boolean {
  let before = -1;
  let moreOfU = 0; // halvings of u, more than levels; of v as many fewer
  for (let fives = slabs; fives !== 0; fives >>= 5) {
    const split = levelOfSlabs(fives & 31);
    if (split <= before || split >= level) return false;
    before = split;
    moreOfU += splitOfSlabs(fives & 31) === SLABS_ALONG_U ? 1 : -1;
  }
  return level + Math.abs(moreOfU) <= MAX_LEVEL;
}

/**
 * Returns the path of the patch in the same place of a root whose (u, v) is this one's (v, u): children 1 and 2 of quarters change
 * places, and slabs keep theirs.
 */
export function mirrored(path: number, slabs = 0): number {
  const end = path & -path;
  const children = (path - end) >>> 1;
  let swapped = ((children & 0x15555555) << 1) | ((children >>> 1) & 0x15555555);
  for (let fives = slabs; fives !== 0; fives >>= 5) {
    const kept = 3 << (2 * (MAX_LEVEL - 1 - levelOfSlabs(fives & 31)));
    swapped = (swapped & ~kept) | (children & kept);
  }
  return 2 * swapped + end;
}

/** Returns the split of the patch in the same place of such a root. */
export function mirroredSplit(how: number): number {
  return how === QUARTERS ? QUARTERS : SLABS_ALONG_U + SLABS_ALONG_V - how;
}
