// The places of a scene's objects and lights when its edits are made, for the handle by which a part is dragged.

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
  /** From the axes of `value` to those of the scene: the object that this one hangs from may be turned and have another size. */
  axes: THREE.Matrix4;
}

// The least and the largest ObjectEdit.scale that the server takes.
const [LEAST_SCALE, MOST_SCALE] = [0.01, 100];

export const upOf = (isZUp: boolean) => (isZUp ? new THREE.Vector3(0, 0, 1) : new THREE.Vector3(0, 1, 0));

/** What edits say of an object itself. */
export function ownMotion(name: string, edits: Edit[]): { move: Vector; turn: number; turnAxis?: Vector; scale: number } {
  const own: ReturnType<typeof ownMotion> = { move: { x: 0, y: 0, z: 0 }, turn: 0, scale: 1 };
  for (const { part } of edits) {
    if (part.case !== "object" || part.value.name !== name) continue;
    if (part.value.move) own.move = part.value.move;
    if (part.value.turn !== undefined) [own.turn, own.turnAxis] = [part.value.turn, part.value.turnAxis];
    own.scale = part.value.scale ?? own.scale;
  }
  return own;
}

/** Returns whether a turn is about another axis than the vertical one, as seen from above. */
export const isTipped = (axis: Vector | undefined, up: THREE.Vector3): boolean =>
  axis !== undefined && new THREE.Vector3(axis.x, axis.y, axis.z).normalize().dot(up) < 1 - 1e-9;

/** Returns the motion of an object: its own, then that of the object that it hangs from. */
function motionOf(object: Parts["objects"][0], parts: Parts, edits: Edit[], up: THREE.Vector3): THREE.Matrix4 {
  const { move, turn, turnAxis: axis, scale } = ownMotion(object.name, edits);
  const about = axis ? new THREE.Vector3(axis.x, axis.y, axis.z).normalize() : up;
  const middle = boxOf(object).getCenter(new THREE.Vector3());
  const own = new THREE.Matrix4()
    .makeTranslation(middle.clone().add(new THREE.Vector3(move.x, move.y, move.z)))
    .multiply(new THREE.Matrix4().makeRotationAxis(about, THREE.MathUtils.degToRad(turn)))
    .multiply(new THREE.Matrix4().makeScale(scale, scale, scale))
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
    axes: motionOfParent(object, parts, edits, up).setPosition(0, 0, 0),
  };
}

/** Returns what brings a copy of an object beside the object, turned and as large as it: a copy hangs from nothing. */
export function besideOf(object: Parts["objects"][0], parts: Parts, edits: Edit[], up: THREE.Vector3) {
  const box = boxOf(object);
  const motion = motionOf(object, parts, edits, up);
  const before = box.getCenter(new THREE.Vector3());
  const there = box.clone().applyMatrix4(motion).getSize(new THREE.Vector3());
  const longest = Math.max(there.x, there.y, there.z);
  const move = before.clone().applyMatrix4(motion).sub(before);
  move.x += 1.1 * Math.max(there.x, longest / 4); // a thin panel's copy is to be seen beside it
  return { move: { x: move.x, y: move.y, z: move.z }, ...turnAndSize(motion, up) };
}

/** Takes a motion without a mirror apart; of turns about the vertical there is no axis. */
function turnAndSize(motion: THREE.Matrix4, up: THREE.Vector3): { turn?: number; turnAxis?: Vector; scale?: number } {
  const [turned, size] = [new THREE.Quaternion(), new THREE.Vector3()];
  motion.decompose(new THREE.Vector3(), turned, size);
  if (turned.w < 0) turned.set(-turned.x, -turned.y, -turned.z, -turned.w); // at most half a turn
  const axis = new THREE.Vector3(turned.x, turned.y, turned.z);
  const rounded = (x: number): number => Number(x.toFixed(6));
  const angle = rounded(2 * THREE.MathUtils.radToDeg(Math.atan2(axis.length(), turned.w)));
  const limited = rounded(THREE.MathUtils.clamp(size.x, LEAST_SCALE, MOST_SCALE));
  const scale = limited === 1 ? undefined : limited;
  if (angle === 0) return { scale };
  const alongUp = axis.normalize().dot(up);
  if (Math.abs(alongUp) > 1 - 1e-9) return { turn: alongUp > 0 ? angle : -angle, scale };
  return { turn: angle, turnAxis: { x: axis.x, y: axis.y, z: axis.z }, scale };
}

/** Returns where a light at `position` lies. `centre`: of the mesh, in the scene's own coordinates. */
export function placeOfLight([x, y, z]: Bands, centre: Bands): Place {
  const at = new THREE.Vector3(x, y, z).sub(new THREE.Vector3(...centre));
  return { box: new THREE.Box3(at, at.clone()), motion: new THREE.Matrix4(), value: { x, y, z }, axes: new THREE.Matrix4() };
}
