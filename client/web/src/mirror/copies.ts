// The root patches of objects that edits have added: copies of others.

import { create } from "@bufbuild/protobuf";
import { ReadMeshResponseSchema, SceneObjectSchema, type ReadMeshResponse, type SceneObject } from "../gen/alvor/v1/scene_service_pb";
import type { LookOfObject } from "../gen/alvor/v1/solve_service_pb";

/** Returns the faces of an object and of those that hang from it, in the order of the objects. */
function facesWithHanging(objects: SceneObject[], which: number): number[] {
  const hangs = new Set([which]);
  const faces: number[] = [];
  objects.forEach(({ parent, firstFace, faceCount }, n) => {
    if (parent !== undefined && hangs.has(parent)) hangs.add(n);
    if (hangs.has(n)) for (let k = 0; k < faceCount; ++k) faces.push(firstFace + k);
  });
  return faces;
}

/** Appends the root patches of a copy to the messages of a mesh. */
function withCopy(messages: ReadMeshResponse[], copy: LookOfObject): ReadMeshResponse[] {
  const objects = messages.flatMap(({ sceneObjects }) => sceneObjects);
  const faces = facesWithHanging(objects, copy.copyOf!);
  const faceOfCopy = new Map(faces.map((face, n) => [face, copy.firstFace + n]));
  const total = messages.reduce((count, { cornerCounts }) => count + cornerCounts.length, 0);
  const rootOfCopy = new Map<number, number>();
  let first = 0;
  for (const { sceneFaces } of messages) {
    sceneFaces.forEach((face, n) => faceOfCopy.has(face) && rootOfCopy.set(first + n, total + rootOfCopy.size));
    first += sceneFaces.length;
  }
  const added = create(ReadMeshResponseSchema);
  first = 0;
  for (const message of messages) {
    let corner = 0;
    message.cornerCounts.forEach((count, n) => {
      const [from, to] = [corner, corner + count];
      corner = to;
      if (!rootOfCopy.has(first + n)) return;
      added.cornerCounts.push(count);
      added.materials.push(message.materials[n]);
      added.sceneFaces.push(faceOfCopy.get(message.sceneFaces[n])!);
      const second = message.secondSceneFaces[n] ?? 0;
      added.secondSceneFaces.push(second > 0 ? 1 + (faceOfCopy.get(second - 1) ?? -1) : 0);
      added.cornerCoordinates.push(...message.cornerCoordinates.slice(3 * from, 3 * to));
      added.textureCoordinates.push(...message.textureCoordinates.slice(2 * from, 2 * to));
      added.cornerColors.push(...message.cornerColors.slice(3 * from, 3 * to));
      for (const code of message.neighbours.slice(from, to)) {
        const word = Number(code) - 1; // 8 * root + 2 * edge + smooth, or -1
        const there = word < 0 ? undefined : rootOfCopy.get(Math.floor(word / 8));
        added.neighbours.push(there === undefined ? 0n : BigInt(1 + 8 * there + (word % 8)));
      }
    });
    first += message.cornerCounts.length;
  }
  const { name, firstFace, faceCount } = copy;
  added.sceneObjects.push(create(SceneObjectSchema, { name, firstFace, faceCount, copyOf: copy.copyOf }));
  return [...messages, added];
}

/** Returns the messages of a mesh with the objects that a look tells were added, where they were before edits moved them. */
export function withCopies(messages: ReadMeshResponse[], objects: LookOfObject[]): ReadMeshResponse[] {
  return objects.filter(({ copyOf }) => copyOf !== undefined).reduce(withCopy, messages);
}
