// Colours of controls: sRGB (IEC 61966-2-1) as #rrggbb, and linear bands in [0, 1].

import type { Bands } from "../messages";

const toLinear = (value: number) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4);
const toSrgb = (value: number) => (value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055);

export function linearOf(colour: string): Bands {
  return [1, 3, 5].map((at) => toLinear(parseInt(colour.slice(at, at + 2), 16) / 255)) as Bands;
}

export function colourOf(bands: Bands): string {
  const byte = (band: number) => Math.round(255 * toSrgb(Math.min(1, Math.max(0, band))));
  return `#${bands.map((band) => byte(band).toString(16).padStart(2, "0")).join("")}`;
}
