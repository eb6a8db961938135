// How a pointer takes the chosen part of the scene along.

import * as THREE from "three";
import type { Vector } from "../messages";

/** A line from the eye through a point of the picture, in the scene's axes. `direction` has the length 1. */
export interface EyeRay {
  origin: Vector;
  direction: Vector;
}

const rayOf = ({ origin: o, direction: d }: EyeRay) => new THREE.Ray(new THREE.Vector3(o.x, o.y, o.z), new THREE.Vector3(d.x, d.y, d.z));

/** Returns where a ray meets a box that was moved; undefined if it does not, or begins within. */
export function grabbedBy(ray: EyeRay, box: THREE.Box3, motion: THREE.Matrix4): THREE.Vector3 | undefined {
  const local = rayOf(ray).applyMatrix4(motion.clone().invert());
  if (box.containsPoint(local.origin)) return undefined;
  return local.intersectBox(box, new THREE.Vector3())?.applyMatrix4(motion);
}

/**
 * Returns how far the point that was grabbed goes so that it is under the pointer again: across the floor, or up and down where `isVertical`.
 * Undefined where the pointer is at no such point within `farthest` of the eye.
 */
export function draggedTo(
  eyeRay: EyeRay,
  grabbed: THREE.Vector3,
  up: THREE.Vector3,
  isVertical: boolean,
  farthest: number,
): THREE.Vector3 | undefined {
  const ray = rayOf(eyeRay);
  const normal = isVertical ? ray.direction.clone().projectOnPlane(up).normalize() : up;
  const met = ray.intersectPlane(new THREE.Plane().setFromNormalAndCoplanarPoint(normal, grabbed), new THREE.Vector3());
  if (!met || met.distanceTo(ray.origin) > farthest) return undefined;
  const moved = met.sub(grabbed);
  return isVertical ? moved.projectOnVector(up) : moved.projectOnPlane(up);
}

/** Returns the horizontal axis of the scene that leads away from the eye, and the one that leads to the right. */
export function axesOfView({ x, y, z }: Vector, up: THREE.Vector3): { away: THREE.Vector3; right: THREE.Vector3 } {
  const ahead = new THREE.Vector3(x, y, z);
  const axes = [new THREE.Vector3(1, 0, 0), new THREE.Vector3(0, 1, 0), new THREE.Vector3(0, 0, 1)].filter((axis) => axis.dot(up) === 0);
  const along = axes.reduce((best, axis) => (Math.abs(axis.dot(ahead)) > Math.abs(best.dot(ahead)) ? axis : best));
  const away = along.multiplyScalar(along.dot(ahead) < 0 ? -1 : 1);
  return { away, right: away.clone().cross(up) };
}
