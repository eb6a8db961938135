// The page: what a person does becomes calls to the server and what the room shows.

import { Code, ConnectError } from "@connectrpc/connect";
import { connect, reasonOf, sceneOf } from "../api";
import type { Scene } from "../gen/alvor/v1/scene_service_pb";
import { Solve_State, type EditStep, type Solve } from "../gen/alvor/v1/solve_service_pb";
import { MissingParts, sendSceneFiles, sendWithoutParts } from "../scene_files";
import type { Brightness, Counters, FromWorker, ToWorker } from "../messages";
import { Cameras } from "../view/cameras";
import { isSolutionFile } from "../solution_file";
import { Handle } from "../view/handle";
import { Room } from "../view/room";
import { Chart } from "./chart";
import { button, byId, input, listItem, save, select } from "./dom";
import { glbOf, reportOf } from "./downloads";
import { showCounters, showPlan, showReading } from "./figures";
import { listenToDrops } from "./drops";
import { Editing } from "./editing";
import { addressOf, applyView, solveIn, viewIn } from "./link";
import { takeImages, withdrawWarning } from "./textures";
import { setPhotometric } from "./units";
import { upOf, type Place } from "./place";
import { draw, lookOf } from "./viewing";

const EXAMPLES = ["cornell_box", "furnished_room", "slats_and_boxes", "vault", "enfilade"];
const RATE_HZ = 20;
const POLL_MS = 1000;
const PAUSE_POLL_MS = 50; // while a person waits for it
const NOTE_MS = 4000;
const ADDRESS_MS = 300; // browsers allow a hundred changes in half a minute

const NO_AMBIENT = { r: 0, g: 0, b: 0 };

let token = sessionStorage.getItem("token") ?? "";
const api = connect(location.origin, () => token);
const room = new Room(byId<HTMLCanvasElement>("room"));
const chart = new Chart(byId("chart"));
let isStale = true;
const handle = new Handle<Place>(room, byId("room"), {
  onHold: (isHeld) => {
    cameras.hold(isHeld);
    if (!isHeld) editing.dropped();
  },
  onDrag: (place, by, begins) => editing.drag(place, by, begins),
  onChange: () => (isStale = true),
});
const editing = new Editing(
  api,
  (step) => attempt(() => edit(step)),
  attempt,
  note,
  () => solve?.name,
  (place) => handle.setPlace(place),
);
const cameras = new Cameras(room.camera, byId<HTMLCanvasElement>("room"), viewChanged);

let scene: Scene | undefined;
let solve: Solve | undefined;
/** The name of the newest solve that this tab began. */
let begun = sessionStorage.getItem("begun") ?? "";
let starting = Promise.resolve();
/** The name of a solve that a person asked to pause. */
let pausing = "";
let framedScene = "";
/** Of an address, until there is a mesh to look at. */
let cameraToCome: number[] | undefined;
let addressTimer: ReturnType<typeof setTimeout> | undefined;
let worker: Worker | undefined;
let nextWorker = makeWorker(); // ready before it is needed
let brightness: Brightness = { exposure: 1, lowIrradiance: 0, highIrradiance: 1, lowError: 0, highError: 1 };
let counters: Counters | undefined;
let materials = new Float32Array();
let centre: [number, number, number] = [0, 0, 0];
let isZUp = false;
/** When a frame that is not on the screen yet arrived. */
let arrivedUnseen: number | undefined;
/** The solve has ended, and the worker still holds its last change: it keeps changes until those that it sent before are drawn. */
let isChangeToCome = false;

/** For whoever wants to know how the page does: tests, and the curious. Milliseconds. */
const nothing = {
  solve: "",
  hasEnded: false, // and its last state was told
  isWaiting: false, // for a frame to be drawn, or for the last one that the worker still holds
  firstLit: 0, // after a file was opened
  latency: 0, // of the newest frame, from its arrival to the screen
  latencies: [] as number[],
  applying: 0,
  preparing: 0,
  frames: 0,
  slots: 0,
  longestTask: 0,
};
const measured = structuredClone(nothing);
let openedAt = 0;
Object.assign(window, { alvor: measured });
if (PerformanceObserver.supportedEntryTypes.includes("longtask"))
  new PerformanceObserver((list) => {
    for (const entry of list.getEntries()) measured.longestTask = Math.max(measured.longestTask, entry.duration);
  }).observe({ type: "longtask" });

function say(text: string, kind: "good" | "bad" = "good"): void {
  byId("state").textContent = text;
  byId("state").dataset.kind = kind;
}

/** Says what is news for a moment, and then how the solve is again. */
function note(text: string): void {
  say(text);
  setTimeout(() => byId("state").textContent === text && solve && say(stateText(solve)), NOTE_MS);
}

/** Runs what a person asked for, and says why it could not be. Returns whether it could. */
async function attempt(action: () => Promise<void>): Promise<boolean> {
  try {
    await action();
    return true;
  } catch (error) {
    if (error instanceof ConnectError && error.code === Code.Unauthenticated) byId("token-label").hidden = false;
    say(reasonOf(error), "bad");
    return false;
  }
}

// Scenes

async function open(files: File[]): Promise<void> {
  openedAt = performance.now();
  const solution = files.find(isSolutionFile);
  if (solution) return openSolution(solution);
  say(`Sending ${files.map((file) => file.name).join(", ")}`);
  await openSent(() => sendSceneFiles(api, files));
}

/** Solves a scene that is sent. Where parts of it are missing, offers to do without them. */
async function openSent(send: () => Promise<Scene>): Promise<void> {
  button("without-parts").hidden = true;
  try {
    setScene(await send());
  } catch (error) {
    button("without-parts").hidden = !(error instanceof MissingParts);
    throw error;
  }
  await start();
  void listStored();
}

async function openExample(name: string): Promise<void> {
  const parts = await Promise.all(
    ["obj", "mtl"].map(async (extension) => {
      const response = await fetch(`./scenes/${name}.${extension}`);
      if (!response.ok) throw new Error(`the example ${name} is not here`);
      return new File([await response.blob()], `${name}.${extension}`);
    }),
  );
  await open(parts);
}

function setScene(next: Scene): void {
  scene = next;
  byId("title").textContent = `${next.displayName || next.name}, ${next.faceCount} faces`;
  byId("warnings").replaceChildren(...next.warnings.map(listItem));
  button("start").disabled = false;
}

async function openStored(name: string): Promise<void> {
  setScene(await api.scenes.getScene({ name }));
  const { solves } = await api.solves.listSolves({ parent: name, pageSize: 1 });
  if (solves.length === 0) return start();
  location.hash = solves[0].name;
}

async function listStored(): Promise<void> {
  const { scenes } = await api.scenes.listScenes({ pageSize: 100 });
  const options = scenes.map((stored) => new Option(`${stored.displayName || stored.name} (${stored.faceCount} faces)`, stored.name));
  select("stored").replaceChildren(new Option("Choose…", ""), ...options);
  button("open-stored").disabled = true;
}

// Solves

/** One after the other: the second of two quick clicks cancels what the first began. */
function start(): Promise<void> {
  starting = starting.catch(() => undefined).then(beginSolve);
  return starting;
}

async function cancelBegun(): Promise<void> {
  if (!begun) return;
  try {
    await api.solves.cancelSolve({ name: begun });
  } catch (error) {
    if (ConnectError.from(error).code !== Code.NotFound) throw error;
  }
}

async function beginSolve(): Promise<void> {
  if (!scene || !byId<HTMLFormElement>("solve-form").reportValidity()) return;
  const seconds = input("time").valueAsNumber;
  const spec = {
    tolerance: input("tolerance").valueAsNumber / 100,
    maxDepth: input("depth").valueAsNumber,
    maxElements: BigInt(input("elements").valueAsNumber),
    strategy: Number(select("strategy").value),
    timeLimit: seconds > 0 ? { seconds: BigInt(Math.floor(seconds)), nanos: Math.round((seconds % 1) * 1e9) } : undefined,
  };
  await cancelBegun();
  attach(await api.solves.createSolve({ parent: scene.name, solve: { spec } }));
  begun = solve!.name;
  sessionStorage.setItem("begun", begun);
  history.pushState(null, "", addressOf(begun, cameraToCome ?? (framedScene === scene.name ? cameras.view() : undefined)));
}

/** Shows a solve that may be running, or have ended. */
function attach(next: Solve): void {
  setSolve(next);
  beginToShow(next.name);
  send({ kind: "watch", origin: location.origin, solve: next.name, token, rate: RATE_HZ, longestSide: room.longestSide });
}

/** Shows a solution that was written to a file; no server takes part. */
function openSolution(file: File): void {
  scene = solve = undefined;
  editing.setSteps([], false);
  framedScene = "";
  history.pushState(null, "", location.pathname + location.search);
  byId("title").textContent = file.name;
  byId("warnings").replaceChildren();
  for (const id of ["start", "pause", "cancel"]) button(id).disabled = true;
  say(`Reading ${file.name}`);
  beginToShow("");
  send({ kind: "open", file, longestSide: room.longestSide });
}

function beginToShow(name: string): void {
  worker?.terminate();
  worker = nextWorker;
  nextWorker = makeWorker();
  beginChart();
  counters = arrivedUnseen = undefined;
  isChangeToCome = false;
  room.begin();
  room.setAmbient(NO_AMBIENT);
  isStale = true;
  byId("reading").hidden = true;
  allowSaving(false);
  withdrawWarning();
  Object.assign(measured, structuredClone(nothing), { solve: name });
  worker.onmessage = ({ data }: MessageEvent<FromWorker>) => take(data);
  worker.onerror = () => say("The page has changed on the server: load it again", "bad");
  byId("hint").hidden = true;
}

function beginChart(): void {
  chart.begin(solve?.effectiveSpec?.tolerance ?? 0);
}

function allowSaving(isAllowed: boolean): void {
  for (const id of ["pin", "save-glb", "save-png", "save-report"]) button(id).disabled = !isAllowed;
}

function makeWorker(): Worker {
  return new Worker(new URL("../worker.ts", import.meta.url), { type: "module" });
}

function send(message: ToWorker): void {
  worker?.postMessage(message);
}

const addressed = () => solveIn(location.hash);

/** Keeps the address up to date, for whoever is given it. */
function viewChanged(): void {
  isStale = true;
  clearTimeout(addressTimer);
  addressTimer = setTimeout(() => {
    if (!solve || addressed() !== solve.name || cameraToCome) return;
    const address = addressOf(solve.name, cameras.view());
    if (address !== location.hash) history.replaceState(null, "", address);
  }, ADDRESS_MS);
}

function tellStops(): void {
  byId("exposure-stops").textContent = `${input("exposure").value} EV`;
}

function applyAddressedView(): void {
  const view = viewIn(location.hash);
  if (!view) return;
  cameraToCome = applyView(view);
  tellStops();
  cameras.walk(select("camera").value === "walk");
  if (solve?.name === addressed() && framedScene === sceneOf(solve.name)) goToCamera();
  isStale = true;
}

function goToCamera(): void {
  if (cameraToCome) cameras.setView(cameraToCome);
  cameraToCome = undefined;
}

async function attachToAddress(): Promise<void> {
  const name = addressed();
  if (!name.includes("/solves/")) return;
  applyAddressedView();
  if (name === solve?.name) return;
  const found = await api.solves.getSolve({ name });
  const its = await api.scenes.getScene({ name: sceneOf(name) });
  if (addressed() !== name) return; // another was asked for meanwhile
  setScene(its);
  attach(found);
}

const STATES: Record<Solve_State, string> = {
  [Solve_State.STATE_UNSPECIFIED]: "",
  [Solve_State.QUEUED]: "Waiting for its turn",
  [Solve_State.RUNNING]: "Solving",
  [Solve_State.PAUSED]: "Paused",
  [Solve_State.SUCCEEDED]: "Done",
  [Solve_State.CANCELLED]: "Cancelled",
  [Solve_State.FAILED]: "Failed",
};
const FINAL = [Solve_State.SUCCEEDED, Solve_State.CANCELLED, Solve_State.FAILED];

function stateText({ state, endReason }: Solve): string {
  return STATES[state] + (FINAL.includes(state) && endReason ? `: ${endReason}` : "");
}

let questions = 0;
let newestAnswered = 0;

/** Takes what the server answers of a solve, unless it is shown no more or a later question was answered already. */
async function update(answer: Promise<Solve>): Promise<void> {
  const question = ++questions;
  const found = await answer;
  if (question < newestAnswered || found.name !== solve?.name) return;
  newestAnswered = question;
  setSolve(found);
}

function setSolve(next: Solve): void {
  const isEdited = next.edits.at(-1)?.revision !== solve?.edits.at(-1)?.revision;
  const isPast = isEdited && byId("state").dataset.kind === "bad"; // what was refused before an edit that was taken
  const isNews = next.state !== solve?.state || next.name !== solve.name || isPast;
  solve = next;
  const hasEnded = FINAL.includes(next.state);
  if (next.state !== Solve_State.RUNNING && pausing === next.name) pausing = "";
  button("pause").disabled = hasEnded || pausing === next.name;
  button("cancel").disabled = hasEnded;
  button("pause").textContent = next.state === Solve_State.PAUSED ? "Resume" : "Pause";
  if (isNews) say(stateText(next));
  editing.setSteps(next.edits, ![Solve_State.CANCELLED, Solve_State.FAILED].includes(next.state));
  if (next.plan) showPlan(next.plan);
}

async function pauseOrResume(): Promise<void> {
  const { name, state } = solve!;
  const isPaused = state === Solve_State.PAUSED;
  say(isPaused ? "Resuming…" : "Pausing…");
  button("pause").disabled = true;
  try {
    if (!isPaused) pausing = name;
    await update(isPaused ? api.solves.resumeSolve({ name }) : api.solves.pauseSolve({ name }));
    // The solver stops at the next place from which it can go on.
    for (; pausing === name && solve!.name === name; await wait(PAUSE_POLL_MS)) await update(api.solves.getSolve({ name }));
  } finally {
    if (pausing === name) pausing = "";
    if (solve!.name === name) setSolve(solve!);
  }
}

const wait = (ms: number) => new Promise((resolve) => setTimeout(resolve, ms));

setInterval(() => {
  if (!solve || FINAL.includes(solve.state)) return;
  update(api.solves.getSolve({ name: solve.name })).catch(() => undefined); // the watch says that the connection is lost
}, POLL_MS);

// Edits

async function edit(step: EditStep): Promise<void> {
  const { name } = solve!;
  await api.solves.editSolve({ name, step });
  await update(api.solves.getSolve({ name }));
}

// The worker

function take(message: FromWorker): void {
  switch (message.kind) {
    case "mesh": {
      materials = message.materials as Float32Array<ArrayBuffer>;
      centre = message.centre;
      room.setMaterials(materials, message.transmittances);
      room.camera.aspect = Math.max(0.1, byId("room").clientWidth / byId("room").clientHeight);
      isZUp = message.isZUp;
      setPhotometric(message.isPhotometric);
      room.setUp(isZUp);
      const isSameScene = solve !== undefined && framedScene === sceneOf(solve.name); // to which an object was added
      if (!isSameScene) handle.setScene(upOf(isZUp), message.extent);
      editing.setParts(message.parts, centre, upOf(isZUp), isSameScene);
      if (!isSameScene) cameras.frame(message.corners, message.counts, message.extent, isZUp);
      framedScene = solve ? sceneOf(solve.name) : "";
      goToCamera();
      return;
    }
    case "look":
      materials = message.materials as Float32Array<ArrayBuffer>;
      room.setMaterials(materials, message.transmittances);
      isStale = true;
      measured.hasEnded = false;
      return void update(api.solves.getSolve({ name: solve!.name })).catch(() => undefined);
    case "change":
      room.take(message.change);
      ({ brightness, counters } = message);
      arrivedUnseen = counters.arrived;
      isChangeToCome = false;
      measured.isWaiting = true;
      allowSaving(true);
      isStale = true;
      return;
    case "sheet":
    case "piece":
    case "no images":
      isStale = true;
      return takeImages(room, message);
    case "steps":
      if (message.isFirst) beginChart();
      chart.add(message.steps);
      isStale = true;
      room.setAmbient(message.steps.at(-1)?.ambientIrradiance ?? NO_AMBIENT);
      return tellCounters();
    case "connection":
      return showConnection(message.state, message.reason);
    case "ended":
      measured.hasEnded = true;
      isChangeToCome = !message.isShown;
      measured.isWaiting ||= isChangeToCome;
      if (!solve) return say("Shown from a file");
      return void attempt(() => update(api.solves.getSolve({ name: solve!.name })));
    case "refused":
      if (message.needsToken) byId("token-label").hidden = false;
      return say(message.reason, "bad");
    case "probed":
      if (message.reading) editing.choose(message.reading.material, message.reading.object);
      return showReading(message.reading);
  }
}

function tellCounters(): void {
  const step = chart.all.at(-1);
  if (step) showCounters(step, counters, measured.latency);
}

function showConnection(state: Extract<FromWorker, { kind: "connection" }>["state"], reason: string): void {
  if (state === "lost") say(`Connection lost (${reason}), trying again`, "bad");
  if (state === "closing") say(`The server stops (${reason}); trying again`);
  if (state === "resumed") note(`Connected again, going on from ${reason}`);
  if (state === "begun anew") note(`Connected again, from the beginning: ${reason}`);
}

let drawnAt = performance.now();
let countedAt = 0;
function animate(time: number): void {
  requestAnimationFrame(animate);
  cameras.advance((time - drawnAt) / 1000);
  drawnAt = time;
  if (time - countedAt > 250) {
    countedAt = time;
    tellCounters();
  }
  if (!isStale) return;
  isStale = false;
  draw(room, brightness);
  if (arrivedUnseen === undefined) return;
  measured.latency = performance.timeOrigin + performance.now() - arrivedUnseen;
  measured.latencies.push(measured.latency);
  measured.applying = counters!.applying;
  measured.preparing = counters!.preparing;
  if (measured.frames++ === 0) measured.firstLit = performance.now() - openedAt;
  measured.slots = room.slotCount;
  arrivedUnseen = undefined;
  measured.isWaiting = isChangeToCome;
  send({ kind: "drawn" });
}

// What a person can do

function listen(): void {
  const stale = () => (isStale = true);
  input("files").addEventListener("change", () => attempt(() => open([...(input("files").files ?? [])])));
  select("examples").append(...EXAMPLES.map((name) => new Option(name.replaceAll("_", " "), name)));
  button("without-parts").addEventListener("click", () => attempt(() => openSent(() => sendWithoutParts(api))));
  listenToChoice("examples", "open-example", openExample);
  listenToChoice("stored", "open-stored", openStored);
  input("token").addEventListener("change", () => {
    token = input("token").value;
    sessionStorage.setItem("token", token);
    void attempt(async () => {
      await begin();
      if (solve && !measured.hasEnded) attach(solve);
    });
  });
  for (const id of ["scene-form", "view-form", "edit-form"]) byId(id).addEventListener("submit", (event) => event.preventDefault());
  byId("solve-form").addEventListener("submit", (event) => {
    event.preventDefault();
    void attempt(start);
  });
  button("pause").addEventListener("click", () => attempt(pauseOrResume));
  button("cancel").addEventListener("click", () => attempt(() => update(api.solves.cancelSolve({ name: solve!.name }))));
  byId("view-form").addEventListener("input", viewChanged);
  input("split").addEventListener("input", viewChanged);
  input("exposure").addEventListener("input", tellStops);
  select("camera").addEventListener("change", () => cameras.walk(select("camera").value === "walk"));
  button("pin").addEventListener("click", () => {
    room.pin();
    select("comparison").value = "pinned";
    viewChanged();
  });
  window.addEventListener("resize", stale);
  new ResizeObserver(stale).observe(byId("stage"));
  window.addEventListener("hashchange", () => attempt(attachToAddress));
  listenToDrops(byId("stage"), (files) => attempt(async () => open(await files)));
  listenToClicks();
  listenToDownloads();
}

/** Choosing from a list, as arrow keys do, opens nothing yet: its button does, and Enter. */
function listenToChoice(list: string, opener: string, open: (choice: string) => Promise<void>): void {
  const openChosen = () => void attempt(() => open(select(list).value));
  select(list).addEventListener("change", () => (button(opener).disabled = select(list).value === ""));
  select(list).addEventListener("keydown", (event) => {
    if (event.key !== "Enter" || select(list).value === "") return;
    event.preventDefault();
    openChosen();
  });
  button(opener).addEventListener("click", openChosen);
}

/** A click reads a surface; a drag turns the room. */
function listenToClicks(): void {
  const canvas = byId<HTMLCanvasElement>("room");
  let pressed = { x: 0, y: 0 };
  const read = (x: number, y: number) => send({ kind: "probe", ...room.ray(x, y) });
  canvas.addEventListener("pointerdown", (event) => (pressed = { x: event.clientX, y: event.clientY }));
  canvas.addEventListener("click", (event) => {
    if (Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) > 4) return;
    const box = canvas.getBoundingClientRect();
    read((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
  });
  canvas.addEventListener("keydown", (event) => {
    if (event.key === "Enter") read(0.5, 0.5); // the middle of the picture
    if (event.key !== "Escape") return;
    byId("reading").hidden = true;
    editing.release();
  });
}

function listenToDownloads(): void {
  button("save-png").addEventListener("click", () => {
    handle.hideWhile(() => draw(room, brightness));
    byId<HTMLCanvasElement>("room").toBlob((picture) => picture && save("room.png", picture));
  });
  button("save-report").addEventListener("click", () => save("report.csv", reportOf(chart.all)));
  button("save-glb").addEventListener("click", () =>
    attempt(async () => save("room.glb", await glbOf(room.exported(), centre, materials, lookOf(brightness).exposure, isZUp))),
  );
}

async function begin(): Promise<void> {
  await listStored();
  await attachToAddress();
}

listen();
requestAnimationFrame(animate);
void attempt(begin);
