// STL, binary or text. It has no materials; its axes are z up, as in client/assimp_import.cpp.

import { UpAxis } from "../gen/alvor/v1/scene_service_pb";
import { ImportError } from "./import_error";
import { linesOf, tripleOf } from "./lines";
import { SceneBuilder } from "./scene_builder";

const HEADER = 84;
const TRIANGLE = 50;

export async function readStl(file: File): Promise<SceneBuilder> {
  const scene = new SceneBuilder();
  scene.up = UpAxis.Z;
  const material = scene.addDefaultMaterial();
  const bytes = await file.arrayBuffer();
  if (isText(bytes)) readText(new TextDecoder().decode(bytes), scene, material);
  else readBinary(new DataView(bytes), scene, material);
  return scene;
}

/** Binary files may begin with "solid" too: then their length tells. */
function isText(bytes: ArrayBuffer): boolean {
  const hasLength = bytes.byteLength >= HEADER && bytes.byteLength === HEADER + TRIANGLE * new DataView(bytes).getUint32(80, true);
  return !hasLength && new TextDecoder().decode(bytes.slice(0, 256)).trimStart().toLowerCase().startsWith("solid");
}

function readBinary(view: DataView, scene: SceneBuilder, material: number): void {
  if (view.byteLength < HEADER) throw new ImportError("file", "is neither text STL, which begins with 'solid', nor binary STL: it ends within the header");
  const count = view.getUint32(80, true);
  const held = Math.floor((view.byteLength - HEADER) / TRIANGLE);
  if (held < count) throw new ImportError("file", `ends early: it says ${count} triangles and holds ${held}`);
  for (let n = 0; n < count; ++n) {
    const corner = (k: number) => {
      const at = HEADER + TRIANGLE * n + 12 * (k + 1);
      return scene.addVertex(view.getFloat32(at, true), view.getFloat32(at + 4, true), view.getFloat32(at + 8, true));
    };
    scene.addFace([corner(0), corner(1), corner(2)], material);
  }
}

function readText(text: string, scene: SceneBuilder, material: number): void {
  let corners: number[] = [];
  let isEnded = true;
  for (const line of linesOf(text, false)) {
    const keyword = line.keyword.toLowerCase();
    if (keyword === "facet") (corners = []), (isEnded = false);
    if (keyword === "vertex") corners.push(scene.addVertex(...tripleOf(line)));
    if (keyword !== "endfacet") continue;
    if (corners.length !== 3) throw new ImportError(`line ${line.number}`, `the facet has ${corners.length} vertices, not 3`);
    scene.addFace(corners, material);
    isEnded = true;
  }
  if (!isEnded) throw new ImportError("file", "ends within a facet");
}
