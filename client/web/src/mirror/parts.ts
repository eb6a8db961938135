// The lights, lamps and materials of a scene that a person can edit.

import { Light_Kind, type Rgb } from "../gen/alvor/v1/scene_service_pb";
import type { Bands, Parts } from "../messages";
import type { BaseMesh } from "./base_mesh";
import { isAdded } from "./copies";

const NEAR = [Light_Kind.POINT, Light_Kind.SPOT, Light_Kind.LUMINAIRE];
const bandsOf = (value: Rgb | undefined): Bands => [value?.r ?? 0, value?.g ?? 0, value?.b ?? 0];

interface Extent {
  low: number[];
  high: number[];
  shines: boolean;
}

/** Returns the box around all that was submitted, and the objects that have faces, with those that hang from them. */
function extentsOf(mesh: BaseMesh): Pick<Parts, "low" | "high" | "objects"> {
  const shines = mesh.materials.map(({ emission }) => Math.max(...bandsOf(emission)) > 0);
  const nothing = (): Extent => ({ low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity], shines: false });
  const extents = mesh.objects.map(({ name }) => ({ ...nothing(), shines: (mesh.lightsOfAdded.get(name)?.length ?? 0) > 0 }));
  const all = nothing();
  const add = (to: Extent, of: Extent) => {
    to.low = to.low.map((x, k) => Math.min(x, of.low[k]));
    to.high = to.high.map((x, k) => Math.max(x, of.high[k]));
    to.shines ||= of.shines;
  };
  for (let root = 0; root < mesh.rootCount; ++root) {
    const of = nothing();
    of.shines = shines[mesh.material[root]];
    for (let corner = mesh.firstCorner[root]; corner < mesh.firstCorner[root + 1]; ++corner) {
      const place = [...mesh.corners.subarray(3 * corner, 3 * corner + 3)];
      add(of, { low: place, high: place, shines: false });
    }
    const object = mesh.numberOfObject(mesh.sceneFace[root]);
    if (object < 0 || !isAdded(mesh.objects[object])) add(all, of);
    if (object >= 0) add(extents[object], of);
  }
  [...mesh.objects].reverse().forEach(({ parent }, n) => {
    if (parent !== undefined) add(extents[parent], extents[extents.length - 1 - n]);
  });
  const sides = ({ low, high }: Extent) => low.map((x, k) => high[k] - x);
  const objects = mesh.objects.flatMap((object, n) => {
    const { name, parent } = object;
    const own = sides(extents[n]);
    const isRoom = sides(all).filter((side, k) => own[k] >= 0.9 * side).length >= 2;
    const { low, high, shines } = extents[n];
    const above = parent === undefined ? undefined : mesh.objects[parent].name;
    return own[0] >= 0 ? [{ name, parent: above, isAdded: isAdded(object), shines, isRoom, low: low as Bands, high: high as Bands }] : [];
  });
  return { low: all.low as Bands, high: all.high as Bands, objects };
}

/** Requires: no edit was applied yet. */
export function partsOf(mesh: BaseMesh): Parts {
  return {
    lights: [
      ...mesh.lights.map(({ name, kind, intensity, position }) => ({
        name,
        intensity: bandsOf(intensity),
        isFar: !NEAR.includes(kind),
        position: NEAR.includes(kind) ? ([position?.x ?? 0, position?.y ?? 0, position?.z ?? 0] as Bands) : undefined,
      })),
      ...[...mesh.lightsOfAdded].flatMap(([addedWith, lights]) =>
        lights.map(({ name, intensity }) => ({ name, intensity: bandsOf(intensity), isFar: false, addedWith })),
      ),
    ],
    ...extentsOf(mesh),
    materials: mesh.materials.map(({ name, emission, reflectance, texture }) => ({
      name,
      emission: bandsOf(emission),
      reflectance: bandsOf(reflectance),
      hasTexture: texture !== undefined,
    })),
  };
}
