// Reads the surface that a ray meets first: its front, at a place that is no hole.

import type { Reading, Vector } from "../messages";
import { opacityAt, reflectanceAt, type Image } from "../textures/image";
import type { BaseMesh } from "./base_mesh";
import type { Blend } from "./blend";
import { type Mirror, GRID } from "./mirror";
import { mirrored } from "./patch_id";

const LEAST_OPACITY = 1 / 32; // the picture draws no dot of what is less: `thresholds` of view/shaders.ts

interface Hit {
  root: number;
  distance: number;
  /** Where on the root. */
  blend: Blend;
}

/** `origin` is measured from the middle of the mesh. `images`: of the textures; without them, reflectance is its mean and nothing is a hole. */
export function probe(mesh: BaseMesh, mirror: Mirror, origin: Vector, direction: Vector, images?: Image[]): Reading | null {
  const hit = firstFront(mesh, origin, direction, images);
  if (!hit) return null;
  const path = pathOf(hit.blend, mesh.cornersOf(hit.root));
  const node = mirror.leafAt(hit.root, path);
  const material = mesh.materials[mesh.material[hit.root]];
  const irradiance = [0, 1, 2].map((band) => mirror.rgb[3 * node + band]) as [number, number, number];
  const e = material.emission!;
  const [r, g, b] = reflectanceOf(mesh, hit, images);
  const through = transmittedTo(mesh, mirror, hit.root, path);
  const along = (x: "x" | "y" | "z", n: number) => mesh.centre[n] + origin[x] + hit.distance * direction[x];
  return {
    faces: mesh.sceneFacesOf(hit.root),
    object: mesh.objectOfFace(mesh.sceneFace[hit.root])?.name,
    level: mirror.levelOf(node),
    material: material.name,
    place: { x: along("x", 0), y: along("y", 1), z: along("z", 2) },
    irradiance,
    error: mirror.hasErrors ? mirror.errors[node] : undefined,
    radiosity: [e.r + r * irradiance[0] + through[0], e.g + g * irradiance[1] + through[1], e.b + b * irradiance[2] + through[2]],
  };
}

/** Returns the light that comes through from the other side, W/m2. */
function transmittedTo(mesh: BaseMesh, mirror: Mirror, root: number, path: number): [number, number, number] {
  const other = mesh.otherSideOf(root);
  if (other < 0) return [0, 0, 0];
  const { r, g, b } = mesh.transmittanceOf(root);
  const at = 3 * mirror.leafAt(other, mirrored(path));
  return [r * mirror.rgb[at], g * mirror.rgb[at + 1], b * mirror.rgb[at + 2]];
}

/** Returns the reflectance at a point: the material's there, times the colour there. */
function reflectanceOf(mesh: BaseMesh, hit: Hit, images?: Image[]): [number, number, number] {
  const reflectance = materialReflectanceOf(mesh, hit, images);
  if (!mesh.hasColours) return reflectance;
  const colour = new Float64Array(3);
  mesh.colourAt(hit.root, hit.blend, colour, 0);
  return [reflectance[0] * colour[0], reflectance[1] * colour[1], reflectance[2] * colour[2]];
}

function materialReflectanceOf(mesh: BaseMesh, { root, blend }: Hit, images?: Image[]): [number, number, number] {
  const { reflectance, texture } = mesh.materials[mesh.material[root]];
  const image = imageOf(mesh, root, images);
  if (!image) return [reflectance!.r, reflectance!.g, reflectance!.b];
  return reflectanceAt(image, texture!, ...placeOnImage(mesh, root, blend));
}

function isHole(mesh: BaseMesh, { root, blend }: Hit, images?: Image[]): boolean {
  const image = imageOf(mesh, root, images);
  if (!image?.hasOpacity) return false;
  return opacityAt(image, mesh.materials[mesh.material[root]].texture!, ...placeOnImage(mesh, root, blend)) < LEAST_OPACITY;
}

function imageOf(mesh: BaseMesh, root: number, images?: Image[]): Image | undefined {
  const { texture } = mesh.materials[mesh.material[root]];
  return texture && mesh.hasTextures ? images?.[texture.image] : undefined;
}

/** Returns s and t of a point of a root. */
function placeOnImage(mesh: BaseMesh, root: number, blend: Blend): [number, number] {
  const st = new Float64Array(2);
  mesh.textureAt(root, blend, st, 0);
  return [st[0], st[1]];
}

function firstFront(mesh: BaseMesh, origin: Vector, direction: Vector, images?: Image[]): Hit | null {
  let best: Hit | null = null;
  for (let root = 0; root < mesh.rootCount; ++root) {
    if (mesh.isHidden(root)) continue;
    const first = 3 * mesh.firstCorner[root];
    const corner = (c: number): Vector => ({
      x: mesh.corners[first + 3 * c],
      y: mesh.corners[first + 3 * c + 1],
      z: mesh.corners[first + 3 * c + 2],
    });
    for (const second of mesh.cornersOf(root) === 4 ? ([1, 2] as const) : ([1] as const)) {
      const met = meet(corner(0), corner(second), corner(second + 1), origin, direction);
      if (!met || (best && met.distance >= best.distance)) continue;
      const hit: Hit = { root, distance: met.distance, blend: { second, ofSecond: met.b, ofThird: met.c } };
      if (!isHole(mesh, hit, images)) best = hit;
    }
  }
  return best;
}

const minus = (a: Vector, b: Vector): Vector => ({ x: a.x - b.x, y: a.y - b.y, z: a.z - b.z });
const dot = (a: Vector, b: Vector) => a.x * b.x + a.y * b.y + a.z * b.z;
const cross = (a: Vector, b: Vector): Vector => ({
  x: a.y * b.z - a.z * b.y,
  y: a.z * b.x - a.x * b.z,
  z: a.x * b.y - a.y * b.x,
});

/** Weights of the second and third corner (Möller and Trumbore 1997); fronts only. */
function meet(a: Vector, b: Vector, c: Vector, origin: Vector, direction: Vector) {
  const ab = minus(b, a);
  const ac = minus(c, a);
  const p = cross(direction, ac);
  const determinant = dot(ab, p);
  if (!(determinant > 0)) return null;
  const from = minus(origin, a);
  const weightB = dot(from, p) / determinant;
  const q = cross(from, ab);
  const weightC = dot(direction, q) / determinant;
  const distance = dot(ac, q) / determinant;
  return weightB >= 0 && weightC >= 0 && weightB + weightC <= 1 && distance > 0 ? { distance, b: weightB, c: weightC } : null;
}

/** Returns the finest patch there, as bits of an id. */
function pathOf({ second, ofSecond: b, ofThird: c }: Blend, corners: number): number {
  if (corners === 3) return trianglePath(b, c);
  // In the quad's own coordinates, as if it were a parallelogram on either side of the diagonal; exact where it is one.
  return second === 1 ? quadPath(b + c, c) : quadPath(b, b + c);
}

function quadPath(u: number, v: number): number {
  const cell = (x: number) => Math.min(GRID - 1, Math.max(0, Math.floor(x * GRID)));
  let path = 0;
  for (let bit = GRID / 2; bit >= 1; bit /= 2) path = path * 4 + Number((cell(u) & bit) !== 0) + 2 * Number((cell(v) & bit) !== 0);
  return 2 * path + 1;
}

function trianglePath(u: number, v: number): number {
  let path = 0;
  for (let size = GRID / 2; size >= 1; size /= 2) {
    u *= 2;
    v *= 2;
    let child = 3;
    if (u >= 1) (child = 1), (u -= 1);
    else if (v >= 1) (child = 2), (v -= 1);
    else if (u + v < 1) child = 0;
    else (u = 1 - u), (v = 1 - v);
    path = path * 4 + child;
  }
  return 2 * path + 1;
}
