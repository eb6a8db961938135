// What a scene file holds that Alvor does not support yet, in the words of client/unsupported.cpp.

const KINDS = {
  pointLights: ["point light", "point lights", "ignored"],
  spotLights: ["spot light", "spot lights", "ignored"],
  directionalLights: ["directional light", "directional lights", "ignored"],
  otherLights: ["light of another kind", "lights of other kinds", "ignored"],
  transparentMaterials: ["material with alpha", "materials with alpha", "taken for opaque"],
  metals: ["metallic material", "metallic materials", "taken for diffuse"],
  transmissiveMaterials: ["transmissive material", "transmissive materials", "taken for opaque"],
} as const;

export type UnsupportedKind = keyof typeof KINDS;

/** Counts, by kind, of what a reader left out or simplified. */
export class Unsupported {
  private readonly counts = new Map<UnsupportedKind, number>();

  add(kind: UnsupportedKind, isSo = true): void {
    if (isSo) this.counts.set(kind, (this.counts.get(kind) ?? 0) + 1);
  }

  /** Appends one sentence with the count for each kind that occurred. */
  appendWarnings(warnings: string[]): void {
    for (const [kind, [one, many, treatment]] of Object.entries(KINDS)) {
      const count = this.counts.get(kind as UnsupportedKind) ?? 0;
      if (count > 0) warnings.push(`${count} ${count === 1 ? one : many} ${count === 1 ? "is" : "are"} ${treatment}`);
    }
  }
}
