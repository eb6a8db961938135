// The surface's slots in GPU buffers that are written by ranges.

import * as THREE from "three";
import type { Change } from "../mirror/change";
import { SLOT_INDICES, SLOT_VERTICES, type SurfaceChange } from "../mirror/surface";

/** Positions and values of slots as the GPU has them; texture coordinates, colours and transmitted light too if the mesh has them. */
export class Slots {
  readonly geometry = new THREE.BufferGeometry();
  private room = 4096;

  constructor() {
    this.add("position", 3);
    this.add("value", 4);
    this.geometry.setIndex(dynamic(new Uint32Array(this.room * SLOT_INDICES), 1));
    this.geometry.setDrawRange(0, 0);
  }

  get count(): number {
    return this.geometry.drawRange.count / SLOT_INDICES;
  }

  take(change: SurfaceChange): void {
    this.reserve(change.slotCount);
    this.write("position", change.positions);
    this.write("value", change.values);
    this.writeIfAny("coordinates", 2, change.coordinates);
    this.writeIfAny("vertexColour", 3, change.colours);
    this.writeIfAny("transmitted", 3, change.transmitted);
    this.writeIfAny("error", 1, change.errors);
    write(this.geometry.index!, change.triangles, SLOT_INDICES);
    this.geometry.setDrawRange(0, change.slotCount * SLOT_INDICES);
  }

  /** What is drawn now, in buffers of its own. */
  copy(): THREE.BufferGeometry {
    const copy = new THREE.BufferGeometry();
    for (const [name, { array, itemSize }] of this.attributes())
      copy.setAttribute(name, new THREE.BufferAttribute(array.slice(0, this.count * SLOT_VERTICES * itemSize), itemSize));
    copy.setIndex(new THREE.BufferAttribute(this.geometry.index!.array.slice(0, this.count * SLOT_INDICES), 1));
    return copy;
  }

  dispose(): void {
    this.geometry.dispose();
  }

  private attributes(): [string, THREE.BufferAttribute][] {
    return Object.entries(this.geometry.attributes) as [string, THREE.BufferAttribute][];
  }

  private add(name: string, size: number): void {
    this.geometry.setAttribute(name, dynamic(new Float32Array(this.room * SLOT_VERTICES * size), size));
  }

  private writeIfAny(name: string, size: number, change?: Change): void {
    if (!change) return;
    if (!this.geometry.hasAttribute(name)) this.add(name, size);
    this.write(name, change);
  }

  private write(name: string, change: Change): void {
    const attribute = this.geometry.getAttribute(name) as THREE.BufferAttribute;
    write(attribute, change, SLOT_VERTICES * attribute.itemSize);
  }

  private reserve(slots: number): void {
    if (slots <= this.room) return;
    this.geometry.dispose();
    this.room = Math.max(slots, 2 * this.room);
    for (const [name, { array, itemSize }] of this.attributes()) {
      const larger = new Float32Array(this.room * SLOT_VERTICES * itemSize);
      larger.set(array);
      this.geometry.setAttribute(name, dynamic(larger, itemSize));
    }
    const triangles = new Uint32Array(this.room * SLOT_INDICES);
    triangles.set(this.geometry.index!.array);
    this.geometry.setIndex(dynamic(triangles, 1));
  }
}

function dynamic(array: Float32Array | Uint32Array, size: number): THREE.BufferAttribute {
  return new THREE.BufferAttribute(array, size).setUsage(THREE.DynamicDrawUsage);
}

function write(attribute: THREE.BufferAttribute, change: Change<Float32Array | Uint32Array>, stride: number): void {
  let from = 0;
  for (let n = 0; n < change.ranges.length; n += 2) {
    const start = change.ranges[n] * stride;
    const length = change.ranges[n + 1] * stride;
    attribute.array.set(change.data.subarray(from, from + length), start);
    attribute.addUpdateRange(start, length);
    from += length;
  }
  if (from > 0) attribute.needsUpdate = true;
}
