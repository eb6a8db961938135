// How a person moves: around the room, or within it.

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const WALK_SPEED = 0.35; // of the room's size, each second
const TURN_PER_PIXEL = 0.004;
const UP = new THREE.Vector3(0, 1, 0);

export class Cameras {
  private readonly orbit: OrbitControls;
  private readonly keys = new Set<string>();
  private isWalking = false;
  private isHeld = false;
  private extent = 1;
  private turn: { x: number; y: number } | null = null;
  private framedFrom = new THREE.Vector3();

  /** `onMove` when a picture must be drawn again. */
  constructor(
    private readonly camera: THREE.PerspectiveCamera,
    canvas: HTMLCanvasElement,
    private readonly onMove: () => void,
  ) {
    this.orbit = new OrbitControls(camera, canvas);
    this.orbit.addEventListener("change", onMove);
    this.orbit.listenToKeyEvents(canvas);
    canvas.addEventListener("keydown", (event) => this.isWalking && this.keys.add(event.code));
    canvas.addEventListener("keyup", (event) => this.keys.delete(event.code));
    canvas.addEventListener("blur", () => this.keys.clear());
    canvas.addEventListener("pointerdown", (event) => (this.turn = { x: event.clientX, y: event.clientY }));
    window.addEventListener("pointerup", () => (this.turn = null));
    window.addEventListener("pointermove", (event) => this.look(event));
  }

  /** Looks at the mesh from where most of its fronts can be seen and least of its backs. Corners are measured from its middle. */
  frame(meshCorners: Float32Array, counts: Uint8Array, extent: number, isZUp: boolean): void {
    this.extent = extent;
    const corners = isZUp ? uprightY(meshCorners) : meshCorners;
    const size = boxOf(corners);
    const from = bestSide(corners, counts);
    const wide = Math.abs(from.x) > 0 ? size.z : size.x;
    const deep = Math.abs(from.x) > 0 ? size.x : size.z;
    const angle = Math.tan(THREE.MathUtils.degToRad(this.camera.fov / 2));
    const far = Math.max(size.y, wide / Math.max(this.camera.aspect, 0.1)) / 2 / angle;
    this.camera.near = extent * 1e-3;
    this.camera.far = extent * 20;
    this.camera.updateProjectionMatrix();
    this.camera.position.copy(from).multiplyScalar(deep / 2 + 1.06 * far);
    this.orbit.target.set(0, 0, 0);
    this.orbit.update();
    this.framedFrom.copy(this.camera.position);
    this.onMove();
  }

  /** Returns where a person moved the camera, and what it looks at, measured from the mesh's middle; undefined as framed. */
  view(): number[] | undefined {
    const { position } = this.camera;
    const target = this.isWalking ? position.clone().add(this.camera.getWorldDirection(new THREE.Vector3())) : this.orbit.target;
    const isAsFramed = !this.isWalking && position.distanceTo(this.framedFrom) < 1e-6 * this.extent && target.length() < 1e-6 * this.extent;
    return isAsFramed ? undefined : [...position.toArray(), ...target.toArray()];
  }

  /** Goes where view() said. */
  setView([x, y, z, ...target]: number[]): void {
    this.camera.position.set(x, y, z);
    this.orbit.target.fromArray(target);
    this.camera.lookAt(this.orbit.target);
    if (!this.isWalking) this.orbit.update();
    this.onMove();
  }

  /** Whether the pointer does something else. */
  hold(isHeld: boolean): void {
    this.isHeld = isHeld;
    this.turn = null;
    this.orbit.enabled = !isHeld && !this.isWalking;
  }

  walk(isWalking: boolean): void {
    this.isWalking = isWalking;
    this.orbit.enabled = !isWalking;
    if (isWalking) return;
    const ahead = this.camera.getWorldDirection(new THREE.Vector3());
    this.orbit.target.copy(this.camera.position).addScaledVector(ahead, this.extent / 2);
    this.orbit.update();
  }

  /** Before each picture. */
  advance(seconds: number): void {
    if (!this.isWalking || this.keys.size === 0) return;
    const ahead = this.camera.getWorldDirection(new THREE.Vector3());
    const right = ahead.clone().cross(UP).normalize();
    const axis = (plus: string[], minus: string[]) =>
      Number(plus.some((key) => this.keys.has(key))) - Number(minus.some((key) => this.keys.has(key)));
    const step = seconds * WALK_SPEED * this.extent;
    this.camera.position
      .addScaledVector(ahead, step * axis(["KeyW", "ArrowUp"], ["KeyS", "ArrowDown"]))
      .addScaledVector(right, step * axis(["KeyD", "ArrowRight"], ["KeyA", "ArrowLeft"]))
      .addScaledVector(UP, step * axis(["KeyE", "PageUp"], ["KeyQ", "PageDown"]));
    this.onMove();
  }

  private look(event: PointerEvent): void {
    if (!this.isWalking || !this.turn || this.isHeld) return;
    const turned = new THREE.Euler().setFromQuaternion(this.camera.quaternion, "YXZ");
    turned.y += TURN_PER_PIXEL * (event.clientX - this.turn.x);
    turned.x = THREE.MathUtils.clamp(turned.x + TURN_PER_PIXEL * (event.clientY - this.turn.y), -1.5, 1.5);
    this.camera.quaternion.setFromEuler(turned);
    this.turn = { x: event.clientX, y: event.clientY };
    this.onMove();
  }
}

/** Turns z up to y up. */
function uprightY(corners: Float32Array): Float32Array {
  const turned = new Float32Array(corners.length);
  for (let n = 0; n < corners.length; n += 3) turned.set([corners[n], corners[n + 2], -corners[n + 1]], n);
  return turned;
}

function boxOf(corners: Float32Array): THREE.Vector3 {
  return new THREE.Box3().setFromArray(corners).getSize(new THREE.Vector3());
}

const SIDES = [new THREE.Vector3(0, 0, 1), new THREE.Vector3(0, 0, -1), new THREE.Vector3(1, 0, 0), new THREE.Vector3(-1, 0, 0)];

function bestSide(corners: Float32Array, counts: Uint8Array): THREE.Vector3 {
  const score = SIDES.map(() => 0);
  const at = (n: number) => new THREE.Vector3().fromArray(corners, 3 * n);
  for (let root = 0, first = 0; root < counts.length; first += counts[root++]) {
    const last = first + counts[root] - 1;
    const across = counts[root] === 4 ? at(last).sub(at(first + 1)) : at(last).sub(at(first));
    const area = at(first + 2).sub(at(first));
    const normal = counts[root] === 4 ? area.cross(across) : at(first + 1).sub(at(first)).cross(across);
    SIDES.forEach((side, n) => (score[n] += Math.max(normal.dot(side), 0.6 * normal.dot(side))));
  }
  return SIDES[score.indexOf(Math.max(...score))].clone();
}
