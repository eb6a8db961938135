// What a person can take home.

import { BufferAttribute, BufferGeometry, Mesh, MeshBasicMaterial } from "three";
import { GLTFExporter } from "three/addons/exporters/GLTFExporter.js";
import type { Step } from "../gen/alvor/v1/solve_service_pb";
import { secondsOf } from "./time";

const UP_KEY = "alvor_up";

/** As `alvor solve --report` writes it. */
export function reportOf(steps: readonly Step[]): Blob {
  const lines = steps.map((step) =>
    [secondsOf(step.elapsed), step.step, step.shots, step.rays, step.leaves, step.unshotFraction, step.estimatedError].join(),
  );
  return new Blob([["elapsed_s,step,shots,rays,leaves,unshot_fraction,estimated_error", ...lines, ""].join("\n")], {
    type: "text/csv",
  });
}

/**
 * Returns the triangles with radiosity, irradiance and its told error as float32 attributes, and COLOR_0, exposed radiosity, for viewers that know neither.
 * Colours of the scene's corners are in the radiosity, and so is light that comes through. `drawn` is measured from `centre`, in the scene's axes; the GLB's are y up.
 */
export async function glbOf(drawn: BufferGeometry, centre: [number, number, number], materials: Float32Array, exposure: number, isZUp: boolean): Promise<Blob> {
  const geometry = new BufferGeometry();
  const values = drawn.getAttribute("value");
  const colours = drawn.hasAttribute("vertexColour") ? drawn.getAttribute("vertexColour") : undefined;
  const transmitted = drawn.hasAttribute("transmitted") ? drawn.getAttribute("transmitted") : undefined;
  const bands = () => new Float32Array(3 * values.count);
  const [irradiance, radiosity, colour] = [bands(), bands(), bands()];
  for (let n = 0; n < values.count; ++n)
    for (let band = 0; band < 3; ++band) {
      const at = 3 * n + band;
      const material = 8 * values.getW(n) + band;
      irradiance[at] = values.getComponent(n, band);
      const reflectance = materials[material + 4] * (colours?.getComponent(n, band) ?? 1);
      radiosity[at] = materials[material] + reflectance * irradiance[at] + (transmitted?.getComponent(n, band) ?? 0);
      colour[at] = Math.min(1, exposure * radiosity[at]);
    }
  geometry.setAttribute("position", drawn.getAttribute("position"));
  geometry.setAttribute("color", new BufferAttribute(colour, 3));
  geometry.setAttribute("_irradiance", new BufferAttribute(irradiance, 3));
  geometry.setAttribute("_radiosity", new BufferAttribute(radiosity, 3));
  if (drawn.hasAttribute("error")) geometry.setAttribute("_error", drawn.getAttribute("error"));
  const isLeftOut = (vertex: number) => materials[8 * values.getW(vertex) + 3] > 0.5;  // a pane: see docs/surfaces.md
  geometry.setIndex(trianglesOf(drawn, isLeftOut));
  const mesh = new Mesh(geometry, new MeshBasicMaterial({ vertexColors: true }));
  const [x, y, z] = centre;
  mesh.position.set(x, y, z);
  if (isZUp) {
    // `alvor` knows from this that the scene's axes were others: client/glb_file.cpp.
    mesh.position.set(x, z, -y);
    mesh.rotation.x = -Math.PI / 2;
    mesh.userData[UP_KEY] = "z";
  }
  const glb = (await new GLTFExporter().parseAsync(mesh, { binary: true })) as ArrayBuffer;
  return new Blob([glb], { type: "model/gltf-binary" });
}

/** Those with an area whose vertices are not left out. */
function trianglesOf(drawn: BufferGeometry, isLeftOut: (vertex: number) => boolean): number[] {
  const index = drawn.index!.array;
  const kept: number[] = [];
  for (let n = 0; n < index.length; n += 3) if (index[n] !== index[n + 1] && !isLeftOut(index[n])) kept.push(index[n], index[n + 1], index[n + 2]);
  return kept;
}
