// The root patches of objects that edits have added: copies of others, or all of another scene.

import { clone, create } from "@bufbuild/protobuf";
import {
  LightSchema,
  MaterialSchema,
  Quantity,
  ReadMeshResponseSchema,
  RgbSchema,
  SceneObjectSchema,
  UpAxis,
  type Light,
  type ReadMeshResponse,
  type Rgb,
  type SceneObject,
} from "../gen/alvor/v1/scene_service_pb";
import type { Look, LookOfObject } from "../gen/alvor/v1/solve_service_pb";

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
  const source = objects[copy.copyOf!].name;
  const lights = messages.find((message) => isAddition(message) && message.sceneObjects[0].name === source)?.sceneLights ?? [];
  const named = lights.map((light) => ({ ...light, name: light.name.slice(0, -` of ${source}`.length) }));
  added.sceneLights.push(...lightsOf(named, name));
  return [...messages, added];
}

/** Whether an edit has added an object. */
export const isAdded = ({ copyOf, fromScene }: SceneObject | LookOfObject) => copyOf !== undefined || fromScene !== "";

/** Whether a message has an object that an edit added, and the lights that came with it. */
export const isAddition = ({ sceneObjects: [object] }: ReadMeshResponse) => object !== undefined && isAdded(object);

const LUMENS_PER_WATT = 179; // as the server converts

/** By what light of an added mesh is multiplied in another one. */
function factorOf([added]: ReadMeshResponse[], [mesh]: ReadMeshResponse[]): number {
  const isPhotometric = (message?: ReadMeshResponse) => message?.quantity === Quantity.PHOTOMETRIC;
  if (isPhotometric(added) === isPhotometric(mesh)) return 1;
  return isPhotometric(added) ? 1 / LUMENS_PER_WATT : LUMENS_PER_WATT;
}

const times = (factor: number, light?: Rgb) =>
  light && create(RgbSchema, { r: factor * light.r, g: factor * light.g, b: factor * light.b });

/** Lights that come with an object. */
const lightsOf = (lights: Light[], object: string, factor = 1) =>
  lights.map((light) =>
    Object.assign(clone(LightSchema, light), { name: `${light.name} of ${object}`, intensity: times(factor, light.intensity) }),
  );

const countOf = <T>(messages: ReadMeshResponse[], list: (message: ReadMeshResponse) => T[]) =>
  messages.reduce((count, message) => count + list(message).length, 0);

/** Turns x, y, z of points about x where the axis that points up is another one. */
export function turnedUpright(coordinates: number[], wasZUp: boolean, isZUp: boolean): number[] {
  if (wasZUp === isZUp) return coordinates;
  const sign = isZUp ? 1 : -1; // y becomes z and z becomes -y, or back
  return coordinates.map((value, n) => [value, -sign * coordinates[n + 1], sign * coordinates[n - 1]][n % 3]);
}

/** How many images the textures of a mesh have. */
const imagesOf = (messages: ReadMeshResponse[]) =>
  Math.max(0, ...messages.flatMap(({ sceneMaterials }) => sceneMaterials.map(({ texture }) => (texture ? texture.image + 1 : 0))));

/** Appends the root patches of another scene, as one object. Its images come after all others. */
function withScene(messages: ReadMeshResponse[], object: LookOfObject, added: ReadMeshResponse[]): ReadMeshResponse[] {
  const isZUp = ([first]: ReadMeshResponse[]) => first?.upAxis === UpAxis.Z;
  const firstRoot = countOf(messages, ({ cornerCounts }) => cornerCounts);
  const firstImage = imagesOf(messages);
  const factor = factorOf(added, messages);
  const parts = added.map((message) =>
    create(ReadMeshResponseSchema, {
      cornerCounts: message.cornerCounts,
      cornerCoordinates: turnedUpright(message.cornerCoordinates, isZUp(added), isZUp(messages)),
      materials: message.materials.map((material) => object.firstMaterial + material),
      sceneFaces: message.sceneFaces.map((face) => object.firstFace + face),
      secondSceneFaces: message.cornerCounts.map((_, n) => {
        const second = message.secondSceneFaces[n] ?? 0;
        return second > 0 ? object.firstFace + second : 0;
      }),
      neighbours: message.neighbours.map((code) => (code === 0n ? 0n : code + BigInt(8 * firstRoot))),
      textureCoordinates: message.textureCoordinates,
      cornerColors: message.cornerColors,
      sceneMaterials: message.sceneMaterials.map((material) => {
        const own = clone(MaterialSchema, material);
        own.name += ` of ${object.name}`;
        own.emission = times(factor, own.emission);
        if (own.texture) own.texture.image += firstImage;
        return own;
      }),
    }),
  );
  const { name, firstFace, faceCount, fromScene } = object;
  const holder = create(ReadMeshResponseSchema, {
    sceneObjects: [create(SceneObjectSchema, { name, firstFace, faceCount, fromScene })],
    sceneLights: added.flatMap(({ sceneLights }) => lightsOf(sceneLights, name, factor)),
  });
  return alike([...messages, ...parts, holder]);
}

/** Gives all corners texture coordinates, and colours, where some have them. */
function alike(messages: ReadMeshResponse[]): ReadMeshResponse[] {
  const filled = (list: (message: ReadMeshResponse) => number[], size: number, value: number) => {
    if (countOf(messages, list) === 0) return (message: ReadMeshResponse) => list(message);
    return (message: ReadMeshResponse) => {
      const length = (size * message.cornerCoordinates.length) / 3;
      return list(message).length === length ? list(message) : new Array<number>(length).fill(value);
    };
  };
  const coordinates = filled(({ textureCoordinates }) => textureCoordinates, 2, 0);
  const colours = filled(({ cornerColors }) => cornerColors, 3, 1);
  return messages.map((message) => ({ ...message, textureCoordinates: coordinates(message), cornerColors: colours(message) }));
}

/** Objects that edits have added, in the order of their numbers. */
export const addedObjects = ({ objects }: Pick<Look, "objects">) => objects.filter(isAdded);

/** The scenes whose faces a look tells were added, one after the other: their images come in this order. */
export const addedScenes = (look: Pick<Look, "objects">) => addedObjects(look).flatMap(({ fromScene }) => (fromScene ? [fromScene] : []));

/**
 * Returns the messages of a mesh with the objects that a look tells were added, where they were before edits moved them. Requires: `scenes` has
 * the meshes of addedScenes().
 */
export function withAdded(
  messages: ReadMeshResponse[],
  look: Pick<Look, "objects">,
  scenes: ReadonlyMap<string, ReadMeshResponse[]> = new Map(),
): ReadMeshResponse[] {
  return addedObjects(look).reduce(
    (all, object) => (object.fromScene ? withScene(all, object, scenes.get(object.fromScene)!) : withCopy(all, object)),
    messages,
  );
}
