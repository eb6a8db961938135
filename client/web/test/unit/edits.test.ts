import { create } from "@bufbuild/protobuf";
import { describe, expect, it } from "vitest";
import { DaylightSchema, ReadMeshResponseSchema } from "../../src/gen/alvor/v1/scene_service_pb";
import { EditSchema, EditStep_Kind, EditStepSchema, LookSchema } from "../../src/gen/alvor/v1/solve_service_pb";
import { BaseMesh } from "../../src/mirror/base_mesh";
import { partsOf } from "../../src/mirror/parts";
import { choiceOf, clockOf, daylightOf, type DaylightChoice } from "../../src/page/daylight";
import { areAlike, copiesEverMade, copiesThatHold, editsThatHold, freeName, textOfStep, undoAndRedo } from "../../src/page/edits";
import { colourOf, linearOf } from "../../src/page/srgb";

const dim = (name: string, share: number) =>
  create(EditStepSchema, { kind: EditStep_Kind.EDIT, edits: [{ part: { case: "object", value: { name, dim: share } } }], author: "Ann" });
const undo = create(EditStepSchema, { kind: EditStep_Kind.UNDO });
const redo = create(EditStepSchema, { kind: EditStep_Kind.REDO });

describe("steps of edits", () => {
  it("hold unless they were taken back", () => {
    const steps = [dim("a", 0.1), dim("b", 0.2), undo, dim("c", 0.3), undo, redo];
    expect(editsThatHold(steps).map(({ part }) => part.case === "object" && part.value.name)).toEqual(["a", "c"]);
  });

  it("tell whether there is something to take back or to repeat", () => {
    expect(undoAndRedo([])).toEqual({ undo: false, redo: false });
    expect(undoAndRedo([dim("a", 1), undo])).toEqual({ undo: false, redo: true });
    expect(undoAndRedo([dim("a", 1), undo, dim("b", 1)])).toEqual({ undo: true, redo: false });
  });

  it("are alike where they set the same of the same part", () => {
    const object = (name: string, change: object) => create(EditSchema, { part: { case: "object", value: { name, ...change } } });
    const light = create(EditSchema, { part: { case: "light", value: { name: "a", dim: 1 } } });
    expect(areAlike(object("a", { dim: 1 }), object("a", { dim: 0 }))).toBe(true);
    expect(areAlike(object("a", { dim: 1 }), object("b", { dim: 1 }))).toBe(false);
    expect(areAlike(object("a", { dim: 1 }), object("a", { turn: 1 }))).toBe(false);
    expect(areAlike(object("a", { dim: 1 }), light)).toBe(false);
  });

  it("give copies names that are free", () => {
    expect(freeName("chair.003", new Set())).toBe("chair.003 copy");
    expect(freeName("chair.003 copy", new Set(["chair.003 copy", "chair.003 copy 2"]))).toBe("chair.003 copy 3");
    const copy = create(EditSchema, { part: { case: "copy", value: { name: "b", of: "a" } } });
    const made = create(EditStepSchema, { kind: EditStep_Kind.EDIT, edits: [copy] });
    expect(copiesThatHold([made])).toEqual(["b"]);
    expect(copiesThatHold([made, undo])).toEqual([]);
    expect(copiesEverMade([made, undo])).toEqual(["b"]);
  });

  it("are told with who made them", () => {
    expect(textOfStep(dim("lamp", 0.5))).toBe("Ann edited lamp at 50 %");
    expect(textOfStep(undo)).toBe("Somebody took the last edit back");
  });
});

describe("colours of controls", () => {
  it("are linear bands and back", () => {
    for (const colour of ["#000000", "#ffffff", "#804020", "#010203"]) expect(colourOf(linearOf(colour))).toBe(colour);
    expect(linearOf("#bcbcbc")[0]).toBeCloseTo(0.5, 2);
  });
});

describe("a mesh with a look", () => {
  const rgb = (x: number) => ({ r: x, g: x, b: x });
  const mesh = () =>
    new BaseMesh([
      create(ReadMeshResponseSchema, {
        cornerCounts: [3, 3, 3],
        materials: [0, 1, 1],
        sceneFaces: [0, 1, 2],
        cornerCoordinates: [0, 1, 2].flatMap((z) => [0, 0, z, 1, 0, z, 0, 1, z]),
        neighbours: Array<bigint>(9).fill(0n),
        sceneMaterials: [
          { name: "wall", emission: rgb(0), reflectance: rgb(0.5) },
          { name: "lamp", emission: rgb(9), reflectance: rgb(0) },
        ],
        sceneObjects: [
          { name: "left", firstFace: 1, faceCount: 1 },
          { name: "right", firstFace: 2, faceCount: 1 },
        ],
        sceneLights: [{ name: "bulb", kind: 1, intensity: rgb(3), position: { x: 1, y: 2, z: 3 } }],
      }),
    ]);
  const look = create(LookSchema, {
    edits: 1n,
    materials: [
      { number: 0, material: { name: "wall", emission: rgb(0), reflectance: rgb(0.1) } },
      { number: 2, material: { name: "lamp of right", emission: rgb(4), reflectance: rgb(0) } },
    ],
    faces: [{ firstFace: 2, faceCount: 1, material: 2 }],
  });

  it("takes the materials of edits, and gives them back when they were taken back", () => {
    const edited = mesh();
    expect([...edited.applyLook(look).relit]).toEqual([2]);
    expect(edited.materials[0].reflectance!.r).toBe(0.1);
    expect(edited.materials[edited.material[2]].emission!.r).toBe(4);
    expect(edited.materials[edited.material[1]].emission!.r).toBe(9);
    expect([...edited.applyLook(create(LookSchema, { edits: 2n })).relit]).toEqual([2]);
    expect(edited.materials[0].reflectance!.r).toBe(0.5);
    expect(edited.material[2]).toBe(1);
  });

  it("moves and hides objects, and puts them back when that was taken back", () => {
    const edited = mesh();
    const motion = [0, 1, 0, -1, 0, 0, 0, 0, 1, 5, 0, 0]; // a quarter turn about z, then 5 m along x
    const moved = create(LookSchema, { edits: 1n, objects: [{ number: 0, hidden: true }, { number: 1, motion }] });
    const corner = (root: number, c: number) => [0, 1, 2].map((k) => edited.corners[3 * edited.firstCorner[root] + 3 * c + k] + edited.centre[k]);
    expect([...edited.applyLook(moved).moved]).toEqual([1, 2]);
    expect([edited.isHidden(1), edited.isHidden(2)]).toEqual([true, false]);
    expect([corner(2, 0), corner(2, 1), corner(2, 2)]).toEqual([[5, 0, 2], [5, 1, 2], [4, 0, 2]]);
    expect([...edited.applyLook(moved).moved]).toEqual([]);
    expect([...edited.applyLook(create(LookSchema, { edits: 2n })).moved]).toEqual([1, 2]);
    expect(edited.isHidden(1)).toBe(false);
    expect(corner(2, 2)).toEqual([0, 1, 2]);
  });

  it("has lights, lamps and materials to edit", () => {
    const parts = partsOf(mesh());
    expect(parts.lights).toEqual([{ name: "bulb", intensity: [3, 3, 3], isFar: false, position: [1, 2, 3] }]);
    expect(parts.objects).toMatchObject(["left", "right"].map((name) => ({ name, shines: true, isRoom: true })));
    expect(parts.objects.map(({ low, high }) => [low, high])).toEqual([0, 1].map((z) => [[-0.5, -0.5, z], [0.5, 0.5, z]])); // from the middle
    expect(parts.materials.map(({ name }) => name)).toEqual(["wall", "lamp"]);
  });
});

describe("daylight", () => {
  const noon: DaylightChoice = { sky: "clear", latitude: 48.1, longitude: 11.6, date: "2026-06-21", minutes: 840, hoursFromUtc: 2 };
  const there = (choice: DaylightChoice) => create(DaylightSchema, daylightOf(choice)!);

  it("is told by place and time", () => {
    expect(there(noon).sunTime!.time!.seconds).toBe(BigInt(Date.UTC(2026, 5, 21, 12) / 1000));
    expect(there({ ...noon, minutes: 60 }).sunTime!.time!.seconds).toBe(BigInt(Date.UTC(2026, 5, 20, 23) / 1000));
    expect(clockOf(9 * 60 + 5)).toBe("09:05");
  });

  it("comes back as it was chosen", () => {
    for (const sky of ["clear", "sun"] as const) expect(choiceOf(there({ ...noon, sky }), { ...noon, minutes: 0 })).toEqual({ ...noon, sky });
    for (const sky of ["overcast", "dark"] as const) expect(choiceOf(there({ ...noon, sky }), noon)).toEqual({ ...noon, sky });
  });

  it("is not told while a field is empty or beyond the Earth", () => {
    for (const bad of [{ latitude: NaN }, { latitude: 91 }, { longitude: -181 }, { date: "" }, { date: "0002-06-21" }, { hoursFromUtc: NaN }, { hoursFromUtc: 1e300 }])
      expect(daylightOf({ ...noon, ...bad })).toBeUndefined();
  });

  it("is shown as far as it is told", () => {
    const choice = { ...noon, sky: "dark" as const, hoursFromUtc: NaN };
    expect(choiceOf(create(DaylightSchema, { sunAzimuthDegrees: 120, sunElevationDegrees: 30 }), choice).sky).toBe("sun");
    expect(choiceOf(there(noon), choice)).toEqual({ ...choice, sky: "clear" });
    expect(there({ ...noon, hoursFromUtc: 5.3333333 }).sunTime!.time!.nanos % 1).toBe(0);
  });

  it("is told with who let it shine", () => {
    const edits = [{ part: { case: "daylight" as const, value: {} } }];
    expect(textOfStep(create(EditStepSchema, { kind: EditStep_Kind.EDIT, edits, author: "Ann" }))).toBe("Ann edited sun and sky");
  });
});
