// The lights, lamps and materials of a scene that a person can edit.

import { Light_Kind, type Rgb } from "../gen/alvor/v1/scene_service_pb";
import type { Bands, Parts } from "../messages";
import type { BaseMesh } from "./base_mesh";

const NEAR = [Light_Kind.POINT, Light_Kind.SPOT, Light_Kind.LUMINAIRE];
const bandsOf = (value: Rgb | undefined): Bands => [value?.r ?? 0, value?.g ?? 0, value?.b ?? 0];

/** Requires: no edit was applied yet. */
export function partsOf(mesh: BaseMesh): Parts {
  const shines = mesh.materials.map(({ emission }) => Math.max(...bandsOf(emission)) > 0);
  const lamps = new Set<string>();
  for (let root = 0; root < mesh.rootCount; ++root) {
    if (!shines[mesh.material[root]]) continue;
    const object = mesh.objectOfFace(mesh.sceneFace[root]);
    if (object) lamps.add(object.name);
  }
  return {
    lights: mesh.lights.map(({ name, kind, intensity, position }) => ({
      name,
      intensity: bandsOf(intensity),
      position: NEAR.includes(kind) ? [position?.x ?? 0, position?.y ?? 0, position?.z ?? 0] : undefined,
    })),
    lamps: [...lamps],
    materials: mesh.materials.map(({ name, emission, reflectance, texture }) => ({
      name,
      emission: bandsOf(emission),
      reflectance: bandsOf(reflectance),
      hasTexture: texture !== undefined,
    })),
  };
}
