// Scene files that a person adds to the scene of a solve, as an object.

import { create } from "@bufbuild/protobuf";
import type { Api } from "../api";
import { UpAxis } from "../gen/alvor/v1/scene_service_pb";
import { EditSchema, type Edit } from "../gen/alvor/v1/solve_service_pb";
import type { Bands, Parts } from "../messages";
import { turnedUpright } from "../mirror/copies";
import { sendSceneAlone } from "../scene_files";
import { firstFree } from "./edits";

/** Where a scene stands: `low` and `high` of the box around it, metres from `centre`, in its own coordinates. */
export type Stand = Pick<Parts, "low" | "high"> & { centre: Bands; isZUp: boolean };

interface Box {
  low: number[];
  high: number[];
}

/** Sends the files as a scene of their own. Returns its name, and the edits that add it as an object in the middle of the floor. */
export async function sendAddition(api: Api, files: File[], taken: Set<string>, stand: Stand): Promise<{ scene: string; name: string; edits: Edit[] }> {
  const scene = await sendSceneAlone(api, files);
  const name = firstFree(scene.displayName.replace(/\.[^.]*$/, "") || "object", taken);
  const box = await boxOf(api, scene.name, stand.isZUp).catch(async (error) => {
    await api.scenes.deleteScene({ name: scene.name }).catch(() => undefined);
    throw error;
  });
  const [x, y, z] = moveToFloor(box, stand);
  const edits = [
    create(EditSchema, { part: { case: "copy", value: { name, scene: scene.name } } }),
    create(EditSchema, { part: { case: "object", value: { name, move: { x, y, z } } } }),
  ];
  return { scene: scene.name, name, edits };
}

/** Returns how far a thing is moved that is put on the middle of the floor. */
export function moveToFloor({ low, high }: Box, { low: floor, centre, isZUp }: Stand): Bands {
  const up = isZUp ? 2 : 1;
  return low.map((least, k) => {
    const move = k === up ? centre[k] + floor[k] - least : centre[k] - (least + high[k]) / 2;
    return Number(move.toFixed(3));
  }) as Bands;
}

/** Returns the box around a scene, turned as it will be when it is added. */
async function boxOf(api: Api, scene: string, isZUp: boolean): Promise<Box> {
  const box: Box = { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] };
  let wasZUp: boolean | undefined;
  for await (const message of api.scenes.readMesh({ name: scene })) {
    wasZUp ??= message.upAxis === UpAxis.Z;
    turnedUpright(message.cornerCoordinates, wasZUp, isZUp).forEach((value, n) => {
      box.low[n % 3] = Math.min(box.low[n % 3], value);
      box.high[n % 3] = Math.max(box.high[n % 3], value);
    });
  }
  return box;
}
