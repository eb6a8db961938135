// The parts of the drawn surface that changed since they were last sent to the page.

/** Slots that changed since the last time: pairs of the first and how many, and their new contents one after the other. */
export interface Change<Data = Float32Array> {
  ranges: Uint32Array;
  data: Data;
}

const GAP = 8; // unchanged slots between two changed ones that are sent along

/** Returns the contents of `slots`, each of `stride` numbers, as `write` writes them. Requires: `slots` is sorted. */
export function collect<Data extends Float32Array | Uint32Array>(
  slots: Int32Array,
  stride: number,
  Kind: new (length: number) => Data,
  write: (slot: number, out: Data, at: number) => void,
): Change<Data> {
  const ranges: number[] = [];
  for (const slot of slots) {
    const last = ranges.length - 2;
    if (last >= 0 && slot - (ranges[last] + ranges[last + 1]) <= GAP) ranges[last + 1] = slot + 1 - ranges[last];
    else ranges.push(slot, 1);
  }
  let total = 0;
  for (let n = 1; n < ranges.length; n += 2) total += ranges[n];
  const data = new Kind(total * stride);
  let at = 0;
  for (let n = 0; n < ranges.length; n += 2)
    for (let slot = ranges[n]; slot < ranges[n] + ranges[n + 1]; ++slot, at += stride) write(slot, data, at);
  return { ranges: Uint32Array.from(ranges), data };
}
