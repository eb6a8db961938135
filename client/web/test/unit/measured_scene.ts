// What tests want to know of the messages of CreateScene.

import { UpAxis, type CreateSceneRequest, type GeometryChunk, type Material } from "../../src/gen/alvor/v1/scene_service_pb";

export type Vec3 = [number, number, number];

export interface Face {
  corners: Vec3[];
  material: Material;
}

export const chunksOf = (messages: CreateSceneRequest[]) =>
  messages.flatMap(({ content }) => (content.case === "chunk" ? [content.value] : [])) as GeometryChunk[];

export const materialsOf = (messages: CreateSceneRequest[]) => chunksOf(messages).flatMap(({ materials }) => materials);

export const bandsOf = (rgb: { r: number; g: number; b: number } | undefined): Vec3 => [rgb!.r, rgb!.g, rgb!.b];

export const upOf = (messages: CreateSceneRequest[]) => chunksOf(messages)[0].upAxis;

/** Faces in order, with their corners as the file has them. */
export function facesOf(messages: CreateSceneRequest[]): Face[] {
  const chunks = chunksOf(messages);
  const coordinates = chunks.flatMap(({ vertexCoordinates }) => vertexCoordinates);
  const materials = materialsOf(messages);
  const faces: Face[] = [];
  for (const { faceCornerCounts, faceMaterials, cornerVertices } of chunks) {
    let first = 0;
    faceCornerCounts.forEach((count, n) => {
      const vertices = cornerVertices.slice(first, (first += count));
      faces.push({ corners: vertices.map((v) => coordinates.slice(3 * v, 3 * v + 3) as Vec3), material: materials[faceMaterials[n]] });
    });
  }
  return faces;
}

const minus = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a: Vec3, b: Vec3) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: Vec3, b: Vec3): Vec3 => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** Figures as tests/import/blender/files/expected.json has them: metres, z up. */
export function measure(messages: CreateSceneRequest[], up = upOf(messages)) {
  const upright = ([x, y, z]: Vec3): Vec3 => (up === UpAxis.Z ? [x, y, z] : [x, -z, y]);
  const measured = { area: 0, signedVolume: 0, triangles: 0, low: [1e9, 1e9, 1e9], high: [-1e9, -1e9, -1e9] };
  for (const { corners } of facesOf(messages)) {
    const [a, ...rest] = corners.map(upright);
    let doubleArea: Vec3 = [0, 0, 0];
    for (let n = 1; n < rest.length; ++n) {
      const part = cross(minus(rest[n - 1], a), minus(rest[n], a));
      doubleArea = doubleArea.map((x, k) => x + part[k]) as Vec3;
      measured.signedVolume += dot(a, cross(rest[n - 1], rest[n])) / 6;
    }
    measured.area += Math.hypot(...doubleArea) / 2;
    measured.triangles += corners.length - 2;
    for (const p of [a, ...rest])
      p.forEach((x, k) => ((measured.low[k] = Math.min(measured.low[k], x)), (measured.high[k] = Math.max(measured.high[k], x))));
  }
  return measured;
}
