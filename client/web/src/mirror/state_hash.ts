// An order-free hash of a state: docs/frame-format.md.

export class StateHash {
  private upper = 0;
  private lower = 0;
  private readonly bits32 = new Uint32Array(3);
  private readonly floats = new Float32Array(this.bits32.buffer);

  get bits(): bigint {
    return (BigInt(this.upper >>> 0) << 32n) | BigInt(this.lower >>> 0);
  }

  /** `upper` and `path` are the halves of the leaf's id. */
  add(upper: number, path: number, rgb: Float32Array, at: number): void {
    this.change(upper, path, rgb, at, 1);
  }

  remove(upper: number, path: number, rgb: Float32Array, at: number): void {
    this.change(upper, path, rgb, at, -1);
  }

  private change(upper: number, path: number, rgb: Float32Array, at: number, sign: number): void {
    let a = 0x9e3779b9;
    let b = 0x85ebca6b;
    const mix = (word: number) => {
      a = Math.imul(a ^ word, 0x9e3779b1);
      a ^= a >>> 15;
      b = Math.imul(b ^ word, 0x85ebca77);
      b ^= b >>> 13;
    };
    mix(upper);
    mix(path);
    for (let band = 0; band < 3; ++band) {
      this.floats[band] = rgb[at + band];
      mix(this.bits32[band]);
    }
    this.upper = (this.upper + sign * finish(a)) | 0;
    this.lower = (this.lower + sign * finish(b)) | 0;
  }
}

function finish(x: number): number {
  x = Math.imul(x ^ (x >>> 16), 0x85ebca6b);
  x = Math.imul(x ^ (x >>> 13), 0xc2b2ae35);
  return x ^ (x >>> 16);
}
