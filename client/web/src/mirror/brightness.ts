// How bright the lit surfaces are: what exposure shows them well, and the range of a false-colour scale. As client/picture/tone_map.cpp.

import type { Brightness } from "../messages";
import type { BaseMesh } from "./base_mesh";
import type { Mirror } from "./mirror";

const MIDDLE = 0.25; // where the logarithmic mean goes, before the curve
const BRIGHT = 1.2; // the brightest surfaces stay below this
const BRIGHT_SHARE = 0.02;
const DARKEST = 1e-3; // of the bright end: what lies below counts as this
const BINS_PER_OCTAVE = 8;
const BINS = 512 * BINS_PER_OCTAVE;

export const luminance = (r: number, g: number, b: number) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

/** Areas by the logarithm of their luminance. */
class Histogram {
  private readonly areas = new Float64Array(BINS);
  private total = 0;

  add(value: number, area: number): void {
    if (!(value > 0)) return;
    const bin = Math.round((Math.log2(value) + 256) * BINS_PER_OCTAVE);
    this.areas[Math.min(BINS - 1, Math.max(0, bin))] += area;
    this.total += area;
  }

  get isEmpty(): boolean {
    return this.total === 0;
  }

  /** What `share` of the area exceeds. */
  upperQuantile(share: number): number {
    let seen = 0;
    for (let bin = BINS - 1; bin > 0; --bin) {
      seen += this.areas[bin];
      if (seen >= share * this.total) return valueOf(bin);
    }
    return valueOf(0);
  }

  logarithmicMean(least: number): number {
    let sum = 0;
    this.areas.forEach((area, bin) => {
      if (area > 0) sum += area * Math.log(Math.max(valueOf(bin), least));
    });
    return Math.exp(sum / this.total);
  }
}

const valueOf = (bin: number) => 2 ** (bin / BINS_PER_OCTAVE - 256);

/** Returns the luminance of the light that comes through a leaf from its other side. */
function transmittedTo(mesh: BaseMesh, mirror: Mirror, node: number, ambient: [number, number, number]): number {
  const root = mirror.root[node];
  const other = mesh.otherSideOf(root);
  if (other < 0) return 0;
  const { r, g, b } = mesh.transmittanceOf(root);
  const h = mirror.meanIrradiance(mirror.nodeBehind(node, other));
  return luminance(r * (h[0] + ambient[0]), g * (h[1] + ambient[1]), b * (h[2] + ambient[2]));
}

export function brightnessOf(mesh: BaseMesh, mirror: Mirror, ambient: [number, number, number]): Brightness {
  const reflecting = new Histogram();
  const emitting = new Histogram();
  const irradiance = new Histogram();
  const errors = new Histogram();
  for (let node = 0; node < mirror.nodeCount; ++node) {
    if (mirror.firstChild[node] !== 0) continue;
    const root = mirror.root[node];
    const area = mesh.area[root] * mirror.shareOf(node);
    const e = mesh.materials[mesh.material[root]].emission!;
    const rho = mesh.meanReflectanceOf(root);
    const hr = mirror.rgb[3 * node] + ambient[0];
    const hg = mirror.rgb[3 * node + 1] + ambient[1];
    const hb = mirror.rgb[3 * node + 2] + ambient[2];
    irradiance.add(luminance(hr, hg, hb), area);
    errors.add(mirror.errors[node], area);
    const through = mesh.isTranslucent ? transmittedTo(mesh, mirror, node, ambient) : 0;
    const b = luminance(e.r + rho.r * hr, e.g + rho.g * hg, e.b + rho.b * hb) + through;
    (e.r > 0 || e.g > 0 || e.b > 0 ? emitting : reflecting).add(b, area);
  }
  const seen = reflecting.isEmpty ? emitting : reflecting;
  if (seen.isEmpty) return { exposure: 1, lowIrradiance: 0, highIrradiance: 0, lowError: 0, highError: 0 };
  const high = seen.upperQuantile(BRIGHT_SHARE);
  return {
    exposure: Math.min(MIDDLE / seen.logarithmicMean(DARKEST * high), BRIGHT / high),
    lowIrradiance: irradiance.isEmpty ? 0 : irradiance.upperQuantile(0.98),
    highIrradiance: irradiance.isEmpty ? 0 : irradiance.upperQuantile(0.02),
    lowError: errors.isEmpty ? 0 : errors.upperQuantile(0.98),
    highError: errors.isEmpty ? 0 : errors.upperQuantile(0.02),
  };
}
