/** Returns the linear value of each sample from 0 to `largest` (IEC 61966-2-1). */
export function linearTable(largest: number): Float64Array {
  return Float64Array.from({ length: largest + 1 }, (_, sample) => {
    const s = sample / largest;
    return s <= 0.04045 ? s / 12.92 : ((s + 0.055) / 1.055) ** 2.4;
  });
}
