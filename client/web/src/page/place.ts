// Where objects and lights lie after edits.

import * as THREE from "three";
import type { Edit } from "../gen/alvor/v1/solve_service_pb";
import type { Bands, Parts, Vector } from "../messages";

/** Where a part lies. In the scene's axes, metres from the middle of the mesh. */
export interface Place {
  /** The box around the part as submitted. */
  box: THREE.Box3;
  /** From where the part was submitted to where it is. */
  motion: THREE.Matrix4;
  /** The value of the edit that moves the part: of an object how far it was moved, of a light its position. */
  value: Vector;
  /** From the axes of `value` to those of the scene: the object that this one hangs from may be turned. */
  axes: THREE.Matrix4;
}

export const upOf = (isZUp: boolean) => (isZUp ? new THREE.Vector3(0, 0, 1) : new THREE.Vector3(0, 1, 0));

/** What edits say of an object itself. */
export function ownMotion(name: string, edits: Edit[]): { move: Vector; turn: number } {
  const own = { move: { x: 0, y: 0, z: 0 }, turn: 0 };
  for (const { part } of edits) {
    if (part.case !== "object" || part.value.name !== name) continue;
    if (part.value.move) own.move = part.value.move;
    own.turn = part.value.turn ?? own.turn;
  }
  return own;
}

/** Returns the motion of an object: its own, then that of the object that it hangs from. */
function motionOf(object: Parts["objects"][0], parts: Parts, edits: Edit[], up: THREE.Vector3): THREE.Matrix4 {
  const { move, turn } = ownMotion(object.name, edits);
  const middle = boxOf(object).getCenter(new THREE.Vector3());
  const own = new THREE.Matrix4()
    .makeTranslation(middle.clone().add(new THREE.Vector3(move.x, move.y, move.z)))
    .multiply(new THREE.Matrix4().makeRotationAxis(up, THREE.MathUtils.degToRad(turn)))
    .multiply(new THREE.Matrix4().makeTranslation(middle.negate()));
  return motionOfParent(object, parts, edits, up).multiply(own);
}

function motionOfParent({ parent }: Parts["objects"][0], parts: Parts, edits: Edit[], up: THREE.Vector3): THREE.Matrix4 {
  const found = parts.objects.find(({ name }) => name === parent);
  return found ? motionOf(found, parts, edits, up) : new THREE.Matrix4();
}

const boxOf = ({ low, high }: Parts["objects"][0]) => new THREE.Box3(new THREE.Vector3(...low), new THREE.Vector3(...high));

/** Returns where an object lies. */
export function placeOfObject(object: Parts["objects"][0], parts: Parts, edits: Edit[], up: THREE.Vector3): Place {
  return {
    box: boxOf(object),
    motion: motionOf(object, parts, edits, up),
    value: ownMotion(object.name, edits).move,
    axes: new THREE.Matrix4().extractRotation(motionOfParent(object, parts, edits, up)),
  };
}

/** Returns what brings a copy of an object beside the object: a copy hangs from nothing. */
export function besideOf(object: Parts["objects"][0], parts: Parts, edits: Edit[], up: THREE.Vector3): { move: Vector; turn: number } {
  const box = boxOf(object);
  const motion = motionOf(object, parts, edits, up);
  const before = box.getCenter(new THREE.Vector3());
  const there = box.clone().applyMatrix4(motion).getSize(new THREE.Vector3());
  const longest = Math.max(there.x, there.y, there.z);
  const move = before.clone().applyMatrix4(motion).sub(before);
  move.x += 1.1 * Math.max(there.x, longest / 4); // a thin panel's copy is to be seen beside it
  return { move: { x: move.x, y: move.y, z: move.z }, turn: turnOf(object, parts, edits) };
}

function turnOf({ name, parent }: Parts["objects"][0], parts: Parts, edits: Edit[]): number {
  const above = parts.objects.find((object) => object.name === parent);
  return ownMotion(name, edits).turn + (above ? turnOf(above, parts, edits) : 0);
}

/** Returns where a light at `position` lies. `centre`: of the mesh, in the scene's own coordinates. */
export function placeOfLight([x, y, z]: Bands, centre: Bands): Place {
  const at = new THREE.Vector3(x, y, z).sub(new THREE.Vector3(...centre));
  return { box: new THREE.Box3(at, at.clone()), motion: new THREE.Matrix4(), value: { x, y, z }, axes: new THREE.Matrix4() };
}
