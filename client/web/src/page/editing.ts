// The controls by which a person edits the scene of a solve: brightness, colour and place of one part at a time.

import { create } from "@bufbuild/protobuf";
import * as THREE from "three";
import type { Api } from "../api";
import { DaylightSchema, type Daylight } from "../gen/alvor/v1/scene_service_pb";
import { EditSchema, EditStep_Kind, EditStepSchema, type Edit, type EditStep } from "../gen/alvor/v1/solve_service_pb";
import type { Bands, Parts, Vector } from "../messages";
import { sendAddition } from "./addition";
import { DaylightControls } from "./daylight";
import { button, byId, input, select } from "./dom";
import { areAlike, copiesEverMade, copiesThatHold, editsThatHold, freeName, textOfStep, undoAndRedo } from "./edits";
import { besideOf, isTipped, ownMotion, placeOfLight, placeOfObject, type Place } from "./place";
import { colourOf, linearOf } from "./srgb";

/** Sends a step to the server. Returns whether it was taken. */
type Send = (step: EditStep) => Promise<boolean>;
/** Does what a person asked for, and says why it could not be done. Returns whether it could. */
type Attempt = (action: () => Promise<void>) => Promise<boolean>;
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
  brightest?: number; // the largest band of what a material emits as submitted
}

// The option that stands for sun and sky.
const DAYLIGHT = "daylight";

export class Editing {
  private parts: Parts = { low: [0, 0, 0], high: [0, 0, 0], lights: [], objects: [], materials: [] };
  private centre: Bands = [0, 0, 0];
  private up = new THREE.Vector3();
  private steps: EditStep[] = [];
  /** Newest edits of slides that have not been sent, because what was sent before has not been answered. */
  private waiting: { edit: Edit; continues: boolean }[] = [];
  /** The edit of a slide that was sent and is not answered yet. */
  private sending?: Edit;
  /** The control that slid last, and the part that it changed. */
  private slid?: { part: string; control: string };
  /** The colour that a person gave a part that shines, its largest band 1. */
  private tint?: { part: string; bands: Bands };
  /** The option of a part that was asked for and is not there yet. */
  private wanted = "";
  /** A person has chosen the part; at first the page has. */
  private isChosen = false;
  /** A part was dragged, and its place is shown when the server has answered. */
  private isDragged = false;
  private isSending = false;
  private readonly daylight = new DaylightControls((value) =>
    this.slide(create(EditSchema, { part: { case: "daylight", value: create(DaylightSchema, value) } })),
  );

  constructor(
    private readonly api: Api,
    private readonly send: Send,
    private readonly attempt: Attempt,
    private readonly note: (text: string) => void,
    private readonly nameOfSolve: () => string | undefined,
    private readonly showPlace: ShowPlace,
  ) {
    select("edit-part").addEventListener("change", () => this.showChosen());
    input("edit-dim").addEventListener("input", () => this.slideBy("edit-dim", () => this.dimmed(input("edit-dim").valueAsNumber)));
    input("edit-colour").addEventListener("input", () =>
      this.slideBy("edit-colour", () => this.coloured(linearOf(input("edit-colour").value))),
    );
    for (const id of ["edit-x", "edit-y", "edit-z"]) input(id).addEventListener("input", () => this.move());
    input("edit-turn").addEventListener("input", () => this.slide(this.objectEdit({ turn: input("edit-turn").valueAsNumber })));
    input("edit-hidden").addEventListener("change", () => this.hide(input("edit-hidden").checked));
    button("edit-copy").addEventListener("click", () => void this.duplicate());
    input("edit-add").addEventListener("change", () => void this.attempt(() => this.add([...(input("edit-add").files ?? [])])));
    button("undo").addEventListener("click", () => this.step(EditStep_Kind.UNDO));
    button("redo").addEventListener("click", () => this.step(EditStep_Kind.REDO));
    input("edit-author").value = sessionStorage.getItem("author") ?? "";
    input("edit-author").addEventListener("change", () => sessionStorage.setItem("author", input("edit-author").value));
  }

  /** `centre`: of the mesh, in the scene's own coordinates. If `isSameScene`, what a person has chosen stays chosen. */
  setParts(parts: Parts, centre: Bands, up: THREE.Vector3, isSameScene: boolean): void {
    [this.parts, this.centre, this.up] = [parts, centre, up];
    if (!isSameScene) this.isChosen = false;
    if (this.listParts() || !this.isSending) this.showPart();
  }

  /** Returns whether another part is chosen than before. */
  private listParts(): boolean {
    const { parts } = this;
    const chosen = select("edit-part").value;
    const copies = new Set(copiesThatHold(this.steps));
    const group = (label: string, kind: string, names: string[]) => {
      const options = document.createElement("optgroup");
      options.label = label;
      options.append(...names.map((name) => new Option(name, `${kind}:${name}`)));
      return names.length > 0 ? [options] : [];
    };
    const there = parts.objects.filter(({ name, isAdded }) => !isAdded || copies.has(name));
    const lights = parts.lights.filter(({ addedWith }) => addedWith === undefined || copies.has(addedWith));
    const named = (counts: (object: Parts["objects"][0]) => boolean) => there.filter(counts).map(({ name }) => name);
    select("edit-part").replaceChildren(
      ...group("Lights", "light", lights.map(({ name }) => name)),
      ...group("Lamps", "object", named(({ shines }) => shines)),
      ...group("Objects", "object", named(({ shines }) => !shines)),
      ...group("Materials", "material", parts.materials.map(({ name }) => name)),
      new Option("Sun and sky", `${DAYLIGHT}:`),
    );
    const isListed = (value: string) => [...select("edit-part").options].some((option) => option.value === value);
    if (this.wanted && isListed(this.wanted)) {
      select("edit-part").value = this.wanted;
      this.wanted = "";
      this.isChosen = true;
    } else if (isListed(chosen)) {
      select("edit-part").value = chosen;
    } else {
      this.isChosen = false;
    }
    return select("edit-part").value !== chosen;
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
    const isOther = (newest?.revision ?? 0n) !== before && this.parts.objects.some(({ isAdded }) => isAdded) && this.listParts();
    if (isOther || (newest && newest.revision > before && !this.isSending)) this.showPart();
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

  /** The chosen part goes this far from a place, in the scene's axes; `begins` a step of its own. */
  drag({ value, axes }: Place, by: Vector, begins: boolean): void {
    const local = new THREE.Vector3(by.x, by.y, by.z).applyMatrix4(axes.clone().invert());
    this.isDragged = true;
    this.moveTo({ x: value.x + local.x, y: value.y + local.y, z: value.z + local.z }, begins);
    this.tellPosition([value.x + local.x, value.y + local.y, value.z + local.z]);
  }

  /** A drag has ended: the part is shown where the server has it, when all was answered. */
  dropped(): void {
    if (!this.isSending) this.showPart();
  }

  private showChosen(): void {
    this.isChosen = true;
    this.showPart();
  }

  /** Edits of slides that the server has not answered yet, the newest last. */
  private get unanswered(): Edit[] {
    return [...(this.sending ? [this.sending] : []), ...this.waiting.map(({ edit }) => edit)];
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
    const edits = [...editsThatHold(this.steps), ...this.unanswered];
    const own = object && ownMotion(name, edits);
    let position: Bands | undefined = own ? [own.move.x, own.move.y, own.move.z] : light?.position;
    const turn = own && (isTipped(own.turnAxis, this.up) ? 0 : own.turn); // sliding it turns the object about the vertical instead
    let hidden = false;
    let reflectance = material?.hasTexture ? undefined : material?.reflectance;
    let emission = material?.emission;
    const bands = (value: { r: number; g: number; b: number }): Bands => [value.r, value.g, value.b];
    for (const { part } of edits) {
      if (part.case === "daylight" && light?.isFar) [dim, intensity] = [1, light.intensity]; // it takes the place of far lights
      if (part.case !== "light" && part.case !== "object" && part.case !== "material") continue;
      if (part.case !== kind || part.value.name !== name) continue;
      if (part.case !== "material") dim = part.value.dim ?? dim;
      if (part.case === "object") hidden = part.value.hidden ?? hidden;
      if (part.case === "light" && part.value.intensity) intensity = bands(part.value.intensity);
      if (part.case === "light" && part.value.position) position = [part.value.position.x, part.value.position.y, part.value.position.z];
      if (part.case === "material" && part.value.reflectance && reflectance) reflectance = bands(part.value.reflectance);
      if (part.case === "material" && part.value.emission) emission = bands(part.value.emission);
    }
    const shines = material && largest(material.emission) > 0;
    if (shines) dim = largest(emission!) / largest(material.emission);
    const remembered = this.tint?.part === select("edit-part").value ? this.tint.bands : undefined;
    const shone = shines ? (dim > 0 ? emission : (remembered ?? material.emission)) : intensity;
    const tint = shone && largest(shone) > 0 ? scaled(shone, 1 / largest(shone)) : undefined;
    const colour = light || shines ? tint : reflectance;
    const isLamp = light !== undefined || shines === true || object?.shines === true;
    return { isLamp, dim, colour, position, turn, hidden, brightest: shines ? largest(material.emission) : undefined };
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
    byId("edit-turn-label").hidden = byId("edit-object").hidden = turn === undefined;
    input("edit-turn").value = String(turn ?? 0);
    byId("edit-turn-degrees").textContent = `${turn ?? 0}°`;
    input("edit-hidden").checked = hidden;
    input("edit-dim").value = String(dim);
    this.tellDim();
    if (colour) input("edit-colour").value = colourOf(colour);
    if (position) this.tellPosition(position);
    const place = position && this.placeOf(position);
    byId("edit-drag").hidden = !place || hidden;
    button("edit-copy").disabled = !place;
    this.showPlace(this.isChosen && !hidden && !byId("edit-form").hidden ? place : undefined);
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
    const { colour, brightest } = this.present();
    if (brightest) this.remember(colour!);
    if (kind === "material")
      return create(EditSchema, { part: { case: "material", value: { name, emission: rgb(scaled(colour!, dim * brightest!)) } } });
    return create(EditSchema, { part: { case: kind === "light" ? "light" : "object", value: { name, dim } } });
  }

  private coloured(colour: Bands): Edit {
    const { kind, name } = this.chosen;
    if (kind === "light") {
      const brightest = largest(this.parts.lights.find((light) => light.name === name)!.intensity);
      const tint = scaled(colour, brightest / (largest(colour) || 1));
      return create(EditSchema, { part: { case: "light", value: { name, intensity: rgb(tint) } } });
    }
    const { dim, brightest } = this.present();
    if (brightest) {
      this.remember(colour);
      const emission = rgb(scaled(colour, (dim * brightest) / (largest(colour) || 1)));
      return create(EditSchema, { part: { case: "material", value: { name, emission } } });
    }
    const reflectance = rgb(colour.map((band) => Math.min(0.95, band)) as Bands);
    return create(EditSchema, { part: { case: "material", value: { name, reflectance } } });
  }

  /** Remembers the colour of the chosen material, which its emission does not tell while it is off. */
  private remember(colour: Bands): void {
    if (largest(colour) > 0) this.tint = { part: select("edit-part").value, bands: scaled(colour, 1 / largest(colour)) };
  }

  /** Moves the part to where the fields say. */
  private move(): void {
    const [x, y, z] = ["edit-x", "edit-y", "edit-z"].map((id) => input(id).valueAsNumber);
    if ([x, y, z].every(Number.isFinite)) this.moveTo({ x, y, z });
  }

  private moveTo(to: Vector, begins = false): void {
    if (this.chosen.kind === "object") return this.slide(this.objectEdit({ move: to }), begins);
    this.slide(create(EditSchema, { part: { case: "light", value: { name: this.chosen.name, position: to } } }), begins);
  }

  private objectEdit(change: { move?: { x: number; y: number; z: number }; turn?: number; hidden?: boolean }): Edit {
    byId("edit-turn-degrees").textContent = `${input("edit-turn").valueAsNumber}°`;
    return create(EditSchema, { part: { case: "object", value: { name: this.chosen.name, ...change } } });
  }

  /** As slide(), by one of the controls of the chosen part. Brightness and colour of a material set one field, but are steps of their own. */
  private slideBy(control: string, edit: () => Edit): void {
    const part = select("edit-part").value;
    const begins = this.slid?.part === part && this.slid.control !== control;
    this.slid = { part, control };
    this.slide(edit(), begins);
  }

  /** Sends the newest of the edits of a slide as soon as the one before was answered; `begins` another slide. */
  private slide(edit: Edit, begins = false): void {
    const last = this.waiting.at(-1);
    if (last && !begins && areAlike(last.edit, edit)) last.edit = edit;
    else this.waiting.push({ edit, continues: !begins });
    if (!this.isSending) void this.sendWaiting();
  }

  private async sendWaiting(): Promise<void> {
    this.isSending = true;
    try {
      let isTaken = true;
      for (let next = this.waiting.shift(); next; next = this.waiting.shift()) {
        const { edit, continues } = next;
        this.sending = edit;
        isTaken = await this.send(create(EditStepSchema, { kind: EditStep_Kind.EDIT, edits: [edit], author: this.author, continues }));
      }
      this.sending = undefined;
      if (!isTaken || this.isDragged) this.showPart();
    } finally {
      this.waiting = [];
      this.sending = undefined;
      this.isSending = this.isDragged = false;
    }
  }

  private hide(hidden: boolean): void {
    void this.send(create(EditStepSchema, { kind: EditStep_Kind.EDIT, edits: [this.objectEdit({ hidden })], author: this.author }));
  }

  /** Puts a copy of the chosen object beside it. */
  private async duplicate(): Promise<void> {
    const { name } = this.chosen;
    const source = this.parts.objects.find((object) => object.name === name)!;
    const motion = besideOf(source, this.parts, editsThatHold(this.steps), this.up);
    const copy = freeName(name, this.takenNames);
    await this.sendAdded(copy, [
      create(EditSchema, { part: { case: "copy", value: { name: copy, of: name } } }),
      create(EditSchema, { part: { case: "object", value: { name: copy, ...motion } } }),
    ]);
  }

  /** Adds what is in scene files as an object. */
  private async add(files: File[]): Promise<void> {
    input("edit-add").value = ""; // the same files may be chosen again
    if (files.length === 0) return;
    const stand = { low: this.parts.low, high: this.parts.high, centre: this.centre, isZUp: this.up.z > 0.5 };
    const solve = this.nameOfSolve();
    this.note(`Sending ${files.map(({ name }) => name).join(", ")}`);
    const { scene, name, edits } = await sendAddition(this.api, files, this.takenNames, stand);
    const isSameSolve = this.nameOfSolve() === solve;
    const isTaken = isSameSolve && (await this.sendAdded(name, edits));
    if (isTaken) return this.note(`${name} was added`);
    await this.api.scenes.deleteScene({ name: scene }).catch(() => undefined); // why it was refused has been said
    if (!isSameSolve) throw new Error(`${name} was not added: another solve was opened meanwhile`);
  }

  private get takenNames(): Set<string> {
    return new Set([...this.parts.objects.map(({ name }) => name), ...copiesEverMade(this.steps)]);
  }

  /** Sends edits that add an object, which is chosen when it is there. Returns whether they were taken. */
  private async sendAdded(name: string, edits: Edit[]): Promise<boolean> {
    const wanted = `object:${name}`;
    this.wanted = wanted;
    const isTaken = await this.send(create(EditStepSchema, { kind: EditStep_Kind.EDIT, edits, author: this.author }));
    if (!isTaken && this.wanted === wanted) this.wanted = "";
    return isTaken;
  }

  private step(kind: EditStep_Kind): void {
    void this.send(create(EditStepSchema, { kind, author: this.author }));
  }

  private get author(): string {
    return input("edit-author").value;
  }
}
