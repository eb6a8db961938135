import * as THREE from "three";
import { describe, expect, it } from "vitest";
import { create } from "@bufbuild/protobuf";
import { EditSchema } from "../../src/gen/alvor/v1/solve_service_pb";
import type { Bands, Parts, Vector } from "../../src/messages";
import { besideOf, placeOfLight, placeOfObject } from "../../src/page/place";
import { axesOfView, draggedTo, grabbedBy } from "../../src/view/dragging";

const UP = new THREE.Vector3(0, 0, 1);
const v = (x: number, y: number, z: number) => new THREE.Vector3(x, y, z);
const near = (a: THREE.Vector3, b: THREE.Vector3, most = 1e-9) => expect(a.distanceTo(b)).toBeLessThan(most);
const towards = (from: THREE.Vector3, to: THREE.Vector3) => ({ origin: from, direction: to.clone().sub(from).normalize() });

// A table of 2 by 1 m, and a lamp on one end of it.
const PARTS: Parts = {
  low: [0, 0, 0],
  high: [1, 1, 1],
  lights: [],
  materials: [],
  objects: [
    { name: "table", isAdded: false, shines: false, isRoom: false, low: [0, 0, 0], high: [2, 1, 1] },
    { name: "lamp", parent: "table", isAdded: false, shines: true, isRoom: false, low: [1.6, 0.4, 0.8], high: [1.8, 0.6, 1] },
  ],
};
type Change = { move?: Vector; turn?: number; turnAxis?: Vector; scale?: number };
const objectEdit = (name: string, change: Change) =>
  create(EditSchema, { part: { case: "object", value: { name, ...change } } });
const place = (name: string, edits: ReturnType<typeof objectEdit>[]) =>
  placeOfObject(PARTS.objects.find((one) => one.name === name)!, PARTS, edits, UP);

describe("the place of a part", () => {
  it("is where edits of it, and of what it hangs from, bring it", () => {
    const edits = [objectEdit("table", { turn: 90 }), objectEdit("lamp", { move: { x: -1, y: 0, z: 0 } }), objectEdit("table", { move: { x: 0, y: 5, z: 0 } })];
    const lamp = place("lamp", edits);
    // The lamp's middle (1.7, 0.5) goes to (0.7, 0.5), turns about (1, 0.5) to (1, 0.2), and goes 5 m with the table.
    near(lamp.box.getCenter(v(0, 0, 0)).applyMatrix4(lamp.motion), v(1, 5.2, 0.9));
    expect(lamp.value).toMatchObject({ x: -1, y: 0, z: 0 });
    near(v(1, 0, 0).applyMatrix4(lamp.axes), v(0, 1, 0));
    near(v(1, 0, 0).applyMatrix4(place("table", edits).axes), v(1, 0, 0));
  });
  it("is where it is made larger and tipped about its middle", () => {
    const table = place("table", [objectEdit("table", { scale: 2, turn: 90, turnAxis: { x: 3, y: 0, z: 0 } })]);
    near(v(2, 1, 0.5).applyMatrix4(table.motion), v(3, 0.5, 1.5)); // from (1, 0.5, 0.5): 1, 0.5, 0 is 2, 1, 0, then 2, 0, 1
  });
  it("of a copy of what is tipped and larger is that of the other, moved aside", () => {
    const edits = [objectEdit("table", { scale: 2, turn: 30, turnAxis: { x: 0, y: 1, z: 0 } }), objectEdit("lamp", { turn: 40 })];
    const { move, ...turned } = besideOf(PARTS.objects[1], PARTS, edits, UP);
    const alone = { ...PARTS.objects[1], name: "copy", parent: undefined };
    const copy = placeOfObject(alone, { ...PARTS, objects: [alone] }, [objectEdit("copy", { move, ...turned })], UP);
    const aside = v(1.7, 0.5, 0.9).applyMatrix4(copy.motion).sub(v(1.7, 0.5, 0.9).applyMatrix4(place("lamp", edits).motion));
    near(v(1.6, 0.4, 1).applyMatrix4(copy.motion), v(1.6, 0.4, 1).applyMatrix4(place("lamp", edits).motion).add(aside), 1e-6);
    expect(aside.x).toBeGreaterThan(0.4);
  });
  it("of a copy of what is turned clockwise is turned clockwise, and not larger than may be", () => {
    const edits = [objectEdit("table", { turn: -160, scale: 50 }), objectEdit("lamp", { scale: 10 })];
    expect(besideOf(PARTS.objects[0], PARTS, edits, UP)).toMatchObject({ turn: -160, scale: 50 });
    expect(besideOf(PARTS.objects[1], PARTS, edits, UP).scale).toBe(100);
  });
  it("of a copy is beside the other, as it is turned, whatever that hangs from", () => {
    const edits = [objectEdit("table", { turn: 90, move: { x: 0, y: 5, z: 0 } }), objectEdit("lamp", { turn: 10 })];
    const lamp = PARTS.objects[1];
    const { move, turn } = besideOf(lamp, PARTS, edits, UP);
    expect(turn).toBe(100);
    // The lamp's middle (1.7, 0.5) is at (1, 6.2), and the copy goes along x by a little more than its length.
    expect(1.7 + move.x).toBeGreaterThan(1.2);
    expect(1.7 + move.x).toBeLessThan(1.4);
    expect(0.5 + move.y).toBeCloseTo(6.2, 9);
    const panel = { ...lamp, parent: undefined, low: [1, 0, 0] as Bands, high: [1, 2, 2] as Bands };
    expect(besideOf(panel, PARTS, [], UP).move.x).toBeGreaterThan(0.4);
  });
  it("of a light is its position", () => {
    const { box, value } = placeOfLight([3, 4, 5], [1, 1, 1]);
    near(box.getCenter(v(0, 0, 0)), v(2, 3, 4));
    expect(value).toEqual({ x: 3, y: 4, z: 5 });
  });
});

describe("a part that is dragged", () => {
  it("is grabbed where the pointer meets its box, as it is turned", () => {
    const turned = place("table", [objectEdit("table", { turn: 90 })]);
    near(grabbedBy(towards(v(1, 1.4, 9), v(1, 1.4, 0)), turned.box, turned.motion)!, v(1, 1.4, 1));
    expect(grabbedBy(towards(v(1.9, 0.5, 9), v(1.9, 0.5, 0)), turned.box, turned.motion)).toBeUndefined();
    const within = towards(v(1, 0.5, 0.5), v(1, 0.5, 9));
    expect(grabbedBy(within, turned.box, turned.motion)).toBeUndefined();
  });
  it("stays under the pointer, at its height", () => {
    const eye = v(0, -10, 5);
    near(draggedTo(towards(eye, v(3, 2, 1)), v(1, 1, 1), UP, false, 100)!, v(2, 1, 0));
  });
  it("goes up and down before the eye where that is asked", () => {
    const eye = v(0, -10, 5);
    near(draggedTo(towards(eye, v(1, 1, 4)), v(1, 1, 1), UP, true, 100)!, v(0, 0, 3));
  });
  it("goes nowhere where the pointer is above the horizon or very far away", () => {
    const eye = v(0, -10, 5);
    expect(draggedTo(towards(eye, v(0, 0, 6)), v(1, 1, 1), UP, false, 100)).toBeUndefined();
    expect(draggedTo(towards(eye, v(0, 500, 1)), v(1, 1, 1), UP, false, 100)).toBeUndefined();
  });
  it("goes away from the eye and to the right by keys", () => {
    const { away, right } = axesOfView(v(-0.9, 0.3, -0.2), UP);
    near(away, v(-1, 0, 0));
    near(right, v(0, 1, 0));
  });
});
