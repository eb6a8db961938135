// A box around the chosen part of the scene, by which a person drags it: across the floor, or up and down with Shift.

import * as THREE from "three";
import type { Vector } from "../messages";
import { axesOfView, draggedTo, grabbedBy } from "./dragging";
import type { Room } from "./room";

// Shares of the scene's extent.
const LEAST_SIZE = 0.02; // a light has no size
const FARTHEST = 4;
const KEY_STEP = 0.02;

/** In the scene's axes, metres from the middle of the mesh: a box, and the motion that brings it to where it is. */
export interface MovedBox {
  box: THREE.Box3;
  motion: THREE.Matrix4;
}

export interface HandleEvents<Place extends MovedBox> {
  /** The part is held: the camera must not move with the pointer. */
  onHold: (isHeld: boolean) => void;
  /** The part is to be this far from `place`, which setPlace() was given; `begins` another drag. */
  onDrag: (place: Place, by: Vector, begins: boolean) => void;
  /** A picture must be drawn again. */
  onChange: () => void;
}

export class Handle<Place extends MovedBox> {
  private readonly lines = new THREE.LineSegments(
    new THREE.EdgesGeometry(new THREE.BoxGeometry()),
    new THREE.LineBasicMaterial({ color: 0x4da3ff, depthTest: false, transparent: true }),
  );
  private up = new THREE.Vector3(0, 1, 0);
  private extent = 1;
  private place?: Place;
  /** How far the part went since setPlace(). */
  private readonly moved = new THREE.Vector3();
  private held?: { pointer: number; at: THREE.Vector3; before: THREE.Vector3; isVertical: boolean; isMoved: boolean };

  /** Must be made before the cameras: of an event that both heed, it must be the first to know. */
  constructor(
    private readonly room: Room,
    private readonly canvas: HTMLCanvasElement,
    private readonly events: HandleEvents<Place>,
  ) {
    this.lines.matrixAutoUpdate = this.lines.visible = false;
    this.lines.renderOrder = 1;
    room.add(this.lines);
    canvas.addEventListener("pointerdown", (event) => this.grab(event));
    canvas.addEventListener("pointermove", (event) => this.drag(event));
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"] as const)
      canvas.addEventListener(end, (event) => this.held?.pointer === event.pointerId && this.release());
    canvas.addEventListener("keydown", (event) => this.nudge(event));
  }

  setScene(up: THREE.Vector3, extent: number): void {
    this.up = up;
    this.extent = extent;
    this.release();
    this.setPlace(undefined);
  }

  /** Of the chosen part; none if nothing that can be moved is chosen. Another place of a part that a person holds is not heeded. */
  setPlace(place: Place | undefined): void {
    if (this.held && place) return;
    this.release();
    this.place = place && { ...place, box: this.largeEnough(place) };
    this.moved.set(0, 0, 0);
    this.show();
  }

  /** For pictures that are saved. */
  hideWhile(action: () => void): void {
    const { visible } = this.lines;
    this.lines.visible = false;
    action();
    this.lines.visible = visible;
  }

  private largeEnough({ box, motion }: Place): THREE.Box3 {
    const least = (LEAST_SIZE * this.extent) / motion.getMaxScaleOnAxis();
    const size = box.getSize(new THREE.Vector3()).max(new THREE.Vector3(least, least, least));
    return new THREE.Box3().setFromCenterAndSize(box.getCenter(new THREE.Vector3()), size);
  }

  private show(): void {
    this.lines.visible = this.place !== undefined;
    if (this.place) {
      const { box } = this.place;
      this.lines.matrix
        .copy(this.motion())
        .multiply(new THREE.Matrix4().makeTranslation(box.getCenter(new THREE.Vector3())))
        .scale(box.getSize(new THREE.Vector3()));
      this.lines.matrixWorldNeedsUpdate = true;
    }
    this.events.onChange();
  }

  private motion(): THREE.Matrix4 {
    return new THREE.Matrix4().makeTranslation(this.moved).multiply(this.place!.motion);
  }

  private rayOf(event: PointerEvent) {
    const box = this.canvas.getBoundingClientRect();
    return this.room.ray((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
  }

  private grabbedAt(event: PointerEvent): THREE.Vector3 | undefined {
    return this.place && grabbedBy(this.rayOf(event), this.place.box, this.motion());
  }

  private grab(event: PointerEvent): void {
    if (this.held || event.button !== 0 || !event.isPrimary) return;
    const at = this.grabbedAt(event);
    if (!at) return;
    this.held = { pointer: event.pointerId, at, before: this.moved.clone(), isVertical: event.shiftKey, isMoved: false };
    this.canvas.setPointerCapture(event.pointerId);
    this.events.onHold(true);
  }

  private drag(event: PointerEvent): void {
    const { held } = this;
    if (!held) return void (this.canvas.style.cursor = this.grabbedAt(event) ? "move" : "");
    if (event.pointerId !== held.pointer) return;
    const by = draggedTo(this.rayOf(event), held.at, this.up, held.isVertical, FARTHEST * this.extent);
    if (!by || (!held.isMoved && by.length() === 0)) return;
    this.go(held.before.clone().add(by), !held.isMoved);
    held.isMoved = true;
  }

  private release(): void {
    if (!this.held) return;
    this.held = undefined;
    this.events.onHold(false);
  }

  /** Alt with an arrow key goes a step away, to the right, ...; with PageUp or PageDown up and down. */
  private nudge(event: KeyboardEvent): void {
    if (!event.altKey || !this.place) return;
    const { away, right } = axesOfView(this.room.ray(0.5, 0.5).direction, this.up);
    const ways: Record<string, [THREE.Vector3, number]> = {
      ArrowUp: [away, 1],
      ArrowDown: [away, -1],
      ArrowRight: [right, 1],
      ArrowLeft: [right, -1],
      PageUp: [this.up, 1],
      PageDown: [this.up, -1],
    };
    if (!(event.key in ways)) return;
    event.preventDefault(); // browsers turn pages by these keys
    event.stopImmediatePropagation();
    const [way, sign] = ways[event.key];
    this.go(this.moved.clone().addScaledVector(way, sign * KEY_STEP * this.extent), !event.repeat);
  }

  private go(moved: THREE.Vector3, begins: boolean): void {
    this.moved.copy(moved);
    this.show();
    this.events.onDrag(this.place!, { x: moved.x, y: moved.y, z: moved.z }, begins);
  }
}
