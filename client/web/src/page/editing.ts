// The controls by which a person edits the scene of a solve: brightness, colour and place of one part at a time.

import { create } from "@bufbuild/protobuf";
import * as THREE from "three";
import { DaylightSchema, type Daylight } from "../gen/alvor/v1/scene_service_pb";
import { EditSchema, EditStep_Kind, EditStepSchema, type Edit, type EditStep } from "../gen/alvor/v1/solve_service_pb";
import type { Bands, Parts, Vector } from "../messages";
import { DaylightControls } from "./daylight";
import { button, byId, input, select } from "./dom";
import { editsThatHold, textOfStep, undoAndRedo } from "./edits";
import { ownMotion, placeOfLight, placeOfObject, type Place } from "./place";
import { colourOf, linearOf } from "./srgb";

/** Sends a step to the server. Returns whether it was taken. */
type Send = (step: EditStep) => Promise<boolean>;
/** Shows where the chosen part is; nothing where none is chosen that can be moved. */
type ShowPlace = (place: Place | undefined) => void;

const rgb = ([r, g, b]: Bands) => ({ r, g, b });
const largest = (bands: Bands) => Math.max(...bands);
const scaled = (bands: Bands, factor: number) => bands.map((band) => factor * band) as Bands;

/** What holds of a part. `turn`: of an object. `position`: of an object how far it was moved. */
interface Present {
  isLamp: boolean;
  dim: number;
  colour?: Bands;
  position?: Bands;
  turn?: number;
  hidden: boolean;
  emission?: Bands;
}

// The option that stands for sun and sky.
const DAYLIGHT = "daylight";

export class Editing {
  private parts: Parts = { lights: [], objects: [], materials: [] };
  private centre: Bands = [0, 0, 0];
  private up = new THREE.Vector3();
  private steps: EditStep[] = [];
  /** A slide that has not been sent, because what was sent before it has not been answered. */
  private waiting?: { edit: Edit; continues: boolean };
  /** A person has chosen the part; at first the page has. */
  private isChosen = false;
  private place?: Place;
  private isSending = false;
  private readonly daylight = new DaylightControls((value) =>
    this.slide(create(EditSchema, { part: { case: "daylight", value: create(DaylightSchema, value) } })),
  );

  constructor(
    private readonly send: Send,
    private readonly showPlace: ShowPlace,
  ) {
    select("edit-part").addEventListener("change", () => this.showChosen());
    input("edit-dim").addEventListener("input", () => this.slide(this.dimmed(input("edit-dim").valueAsNumber)));
    input("edit-colour").addEventListener("input", () => this.slide(this.coloured(linearOf(input("edit-colour").value))));
    for (const id of ["edit-x", "edit-y", "edit-z"]) input(id).addEventListener("input", () => this.move());
    input("edit-turn").addEventListener("input", () => this.slide(this.objectEdit({ turn: input("edit-turn").valueAsNumber })));
    input("edit-hidden").addEventListener("change", () => this.hide(input("edit-hidden").checked));
    button("undo").addEventListener("click", () => this.step(EditStep_Kind.UNDO));
    button("redo").addEventListener("click", () => this.step(EditStep_Kind.REDO));
    input("edit-author").value = sessionStorage.getItem("author") ?? "";
    input("edit-author").addEventListener("change", () => sessionStorage.setItem("author", input("edit-author").value));
  }

  /** `centre`: of the mesh, in the scene's own coordinates. */
  setParts(parts: Parts, centre: Bands, up: THREE.Vector3): void {
    [this.parts, this.centre, this.up] = [parts, centre, up];
    this.isChosen = false;
    const group = (label: string, kind: string, names: string[]) => {
      const options = document.createElement("optgroup");
      options.label = label;
      options.append(...names.map((name) => new Option(name, `${kind}:${name}`)));
      return names.length > 0 ? [options] : [];
    };
    const named = (counts: (object: Parts["objects"][0]) => boolean) => parts.objects.filter(counts).map(({ name }) => name);
    select("edit-part").replaceChildren(
      ...group("Lights", "light", parts.lights.map(({ name }) => name)),
      ...group("Lamps", "object", named(({ shines }) => shines)),
      ...group("Objects", "object", named(({ shines }) => !shines)),
      ...group("Materials", "material", parts.materials.map(({ name }) => name)),
      new Option("Sun and sky", `${DAYLIGHT}:`),
    );
    this.showPart();
  }

  /** The steps that the solve has; none where no solve is shown. */
  setSteps(steps: EditStep[], isEditable: boolean): void {
    const before = this.steps.at(-1)?.revision ?? 0n;
    const newest = steps.at(-1);
    this.steps = steps;
    byId("edit-form").hidden = !isEditable;
    if (!isEditable) this.showPlace(undefined);
    const { undo, redo } = undoAndRedo(steps);
    button("undo").disabled = !undo;
    button("redo").disabled = !redo;
    byId("edit-news").textContent = newest ? textOfStep(newest) : "";
    if (newest && newest.revision > before && !this.isSending && !this.waiting) this.showPart();
  }

  /** Chooses what a person clicked at: an object, or the material of what is no object or the room itself. */
  choose(material: string, object: string | undefined): void {
    const isThing = this.parts.objects.some(({ name, isRoom }) => name === object && !isRoom);
    const wanted = isThing ? `object:${object}` : `material:${material}`;
    if (![...select("edit-part").options].some(({ value }) => value === wanted)) return;
    select("edit-part").value = wanted;
    this.showChosen();
  }

  /** Leaves the part alone: it is no longer marked in the picture. */
  release(): void {
    this.isChosen = false;
    this.showPart();
  }

  /** The chosen part goes this far from where it was shown, in the scene's axes; `begins` a step of its own. */
  drag(by: Vector, begins: boolean): void {
    if (!this.place) return;
    const { value, axes } = this.place;
    const local = new THREE.Vector3(by.x, by.y, by.z).applyMatrix4(axes.clone().invert()).add(new THREE.Vector3(value.x, value.y, value.z));
    this.tellPosition(local.toArray());
    this.move(begins);
  }

  private showChosen(): void {
    this.isChosen = true;
    this.showPart();
  }

  private get chosen(): { kind: string; name: string } {
    const { value } = select("edit-part");
    const colon = value.indexOf(":");
    return { kind: value.slice(0, colon), name: value.slice(colon + 1) };
  }

  /** What holds of the chosen part now. */
  private present(): Present {
    const { kind, name } = this.chosen;
    const object = this.parts.objects.find((one) => kind === "object" && one.name === name);
    const light = this.parts.lights.find((one) => kind === "light" && one.name === name);
    const material = this.parts.materials.find((one) => kind === "material" && one.name === name);
    let dim = 1;
    let intensity = light?.intensity;
    const edits = editsThatHold(this.steps);
    const own = object && ownMotion(name, edits);
    let position: Bands | undefined = own ? [own.move.x, own.move.y, own.move.z] : light?.position;
    const turn = own?.turn;
    let hidden = false;
    let reflectance = material?.hasTexture ? undefined : material?.reflectance;
    let emission = material?.emission;
    const bands = (value: { r: number; g: number; b: number }): Bands => [value.r, value.g, value.b];
    for (const { part } of edits) {
      if (part.case === "daylight" && light && !light.position) [dim, intensity] = [1, light.intensity]; // it takes the place of far lights
      if (part.case === "daylight" || part.case !== kind || part.value.name !== name) continue;
      if (part.case !== "material") dim = part.value.dim ?? dim;
      if (part.case === "object") hidden = part.value.hidden ?? hidden;
      if (part.case === "light" && part.value.intensity) intensity = bands(part.value.intensity);
      if (part.case === "light" && part.value.position) position = [part.value.position.x, part.value.position.y, part.value.position.z];
      if (part.case === "material" && part.value.reflectance && reflectance) reflectance = bands(part.value.reflectance);
      if (part.case === "material" && part.value.emission) emission = bands(part.value.emission);
    }
    const shines = material && largest(material.emission) > 0;
    if (shines) dim = largest(emission!) / largest(material.emission);
    const tint = intensity && largest(intensity) > 0 ? scaled(intensity, 1 / largest(intensity)) : undefined;
    const colour = light ? tint : shines ? undefined : reflectance;
    const isLamp = light !== undefined || shines === true || object?.shines === true;
    return { isLamp, dim, colour, position, turn, hidden, emission: shines ? material.emission : undefined };
  }

  /** The daylight that edits have set; undefined if none has. */
  private presentDaylight(): Daylight | undefined {
    const set = editsThatHold(this.steps).flatMap(({ part }) => (part.case === "daylight" ? [part.value] : []));
    return set.at(-1);
  }

  private showPart(): void {
    this.daylight.show(this.chosen.kind === DAYLIGHT, this.presentDaylight());
    const { isLamp, dim, colour, position, turn, hidden } = this.present();
    byId("edit-dim-label").hidden = !isLamp;
    byId("edit-colour-label").hidden = !colour;
    byId("edit-place").hidden = !position;
    byId("edit-place-title").textContent = turn === undefined ? "Position, m" : "Moved by, m";
    byId("edit-turn-label").hidden = byId("edit-hidden-label").hidden = turn === undefined;
    input("edit-turn").value = String(turn ?? 0);
    byId("edit-turn-degrees").textContent = `${turn ?? 0}°`;
    input("edit-hidden").checked = hidden;
    input("edit-dim").value = String(dim);
    this.tellDim();
    if (colour) input("edit-colour").value = colourOf(colour);
    if (position) this.tellPosition(position);
    this.place = position && this.placeOf(position);
    this.showPlace(this.isChosen && !hidden && !byId("edit-form").hidden ? this.place : undefined);
  }

  private placeOf(position: Bands): Place | undefined {
    const { kind, name } = this.chosen;
    if (kind === "light") return placeOfLight(position, this.centre);
    const object = this.parts.objects.find((one) => one.name === name);
    return object && !object.isRoom ? placeOfObject(object, this.parts, editsThatHold(this.steps), this.up) : undefined;
  }

  private tellPosition(position: number[]): void {
    ["edit-x", "edit-y", "edit-z"].forEach((id, n) => (input(id).value = String(Number(position[n].toFixed(3)))));
  }

  private tellDim(): void {
    byId("edit-dim-percent").textContent = `${Math.round(100 * input("edit-dim").valueAsNumber)} %`;
  }

  private dimmed(dim: number): Edit {
    this.tellDim();
    const { kind, name } = this.chosen;
    const { emission } = this.present();
    if (kind === "material")
      return create(EditSchema, { part: { case: "material", value: { name, emission: rgb(scaled(emission!, dim)) } } });
    return create(EditSchema, { part: { case: kind === "light" ? "light" : "object", value: { name, dim } } });
  }

  private coloured(colour: Bands): Edit {
    const { kind, name } = this.chosen;
    if (kind === "light") {
      const brightest = largest(this.parts.lights.find((light) => light.name === name)!.intensity);
      const tint = scaled(colour, brightest / (largest(colour) || 1));
      return create(EditSchema, { part: { case: "light", value: { name, intensity: rgb(tint) } } });
    }
    const reflectance = rgb(colour.map((band) => Math.min(0.95, band)) as Bands);
    return create(EditSchema, { part: { case: "material", value: { name, reflectance } } });
  }

  /** Moves the part to where the fields say. */
  private move(begins = false): void {
    const [x, y, z] = ["edit-x", "edit-y", "edit-z"].map((id) => input(id).valueAsNumber);
    if (![x, y, z].every(Number.isFinite)) return;
    if (this.chosen.kind === "object") return this.slide(this.objectEdit({ move: { x, y, z } }), begins);
    this.slide(create(EditSchema, { part: { case: "light", value: { name: this.chosen.name, position: { x, y, z } } } }), begins);
  }

  private objectEdit(change: { move?: { x: number; y: number; z: number }; turn?: number; hidden?: boolean }): Edit {
    byId("edit-turn-degrees").textContent = `${input("edit-turn").valueAsNumber}°`;
    return create(EditSchema, { part: { case: "object", value: { name: this.chosen.name, ...change } } });
  }

  /** Sends the newest of the edits of a slide as soon as the one before was answered; `begins` another slide. */
  private slide(edit: Edit, begins = false): void {
    const continues = !begins && (this.waiting?.continues ?? true);
    this.waiting = { edit, continues };
    if (!this.isSending) void this.sendWaiting();
  }

  private async sendWaiting(): Promise<void> {
    this.isSending = true;
    try {
      while (this.waiting) {
        const { edit, continues } = this.waiting;
        this.waiting = undefined;
        const isTaken = await this.send(create(EditStepSchema, { kind: EditStep_Kind.EDIT, edits: [edit], author: this.author, continues }));
        if (!isTaken && !this.waiting) this.showPart();
      }
    } finally {
      this.waiting = undefined;
      this.isSending = false;
    }
  }

  private hide(hidden: boolean): void {
    void this.send(create(EditStepSchema, { kind: EditStep_Kind.EDIT, edits: [this.objectEdit({ hidden })], author: this.author }));
  }

  private step(kind: EditStep_Kind): void {
    void this.send(create(EditStepSchema, { kind, author: this.author }));
  }

  private get author(): string {
    return input("edit-author").value;
  }
}
