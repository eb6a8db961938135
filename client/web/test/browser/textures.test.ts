import { create } from "@bufbuild/protobuf";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { CreateSceneRequestSchema, Texture_Wrap, type Scene } from "../../src/gen/alvor/v1/scene_service_pb";
import { LINEAR } from "../../src/textures/image";
import { Server } from "./server";
import { openBrowser, openPage, pixelAt, waitForEnd, waitForState, type Page } from "./viewer";

let server: Server;
let browser: Browser;
beforeAll(async () => {
  server = new Server();
  await server.start();
  browser = await openBrowser();
});
afterAll(async () => {
  await browser?.close();
  await server?.stop();
});

// The floor's image: its left half is dark, its right half light.
const DARK = 100;
const LIGHT = 188;
const COLUMNS = 64;
const ROWS = 4;
const MEAN = (LINEAR[DARK] + LINEAR[LIGHT]) / 2;

const rgb = (x: number) => ({ r: x, g: x, b: x });
const halves = () => Uint8Array.from({ length: 3 * COLUMNS * ROWS }, (_, n) => (Math.floor(n / 3) % COLUMNS < COLUMNS / 2 ? DARK : LIGHT));

/** A floor of 4 m x 4 m around the origin and a lamp 4 m above its middle, which reflects nothing: both halves get the same light. */
async function floor(isTextured: boolean): Promise<Scene> {
  const painted = { name: "floor", reflectance: rgb(MEAN), texture: isTextured ? { wrapS: Texture_Wrap.CLAMP, wrapT: Texture_Wrap.CLAMP } : undefined };
  const chunk = {
    materials: [painted, { name: "lamp", emission: rgb(10), reflectance: rgb(0) }],
    vertexCoordinates: [-2, 0, -2, -2, 0, 2, 2, 0, 2, 2, 0, -2, -0.5, 4, -0.5, 0.5, 4, -0.5, 0.5, 4, 0.5, -0.5, 4, 0.5],
    faceCornerCounts: [4, 4],
    faceMaterials: [0, 1],
    cornerVertices: [0, 1, 2, 3, 4, 5, 6, 7],
  };
  const image = { images: [{ columns: COLUMNS, rows: ROWS }], texels: halves(), textureCoordinates: [0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0] };
  return server.api.createScene([
    create(CreateSceneRequestSchema, { content: { case: "scene", value: { displayName: "a floor" } } }),
    create(CreateSceneRequestSchema, { content: { case: "chunk", value: { ...chunk, ...(isTextured ? image : {}) } } }),
  ]);
}

/** From above and in front of the floor, at its middle; both measured from the middle of the scene, which is `middle` metres above the floor. */
const eyeFor = (middle: number) => `0_${6 - middle}_5_0_${-middle}_0`;
const DISTANCE = Math.hypot(6, 5);

/** Solves a scene and shows it, when `prepare` has had its way with the page. */
async function show(
  scene: Scene, prepare: (page: Page) => Promise<unknown> = async () => undefined, middle = 2, tolerance = 0.01,
): Promise<Page> {
  const { name } = await server.api.solves.createSolve({ parent: scene.name, solve: { spec: { tolerance } } });
  const page = await openPage(browser, server.url);
  await prepare(page);
  await page.evaluate((hash) => (location.hash = hash), `${name}?tone=linear&ambient=0&eye=${eyeFor(middle)}`);
  await waitForEnd(page, name);
  return page;
}

/** Returns where on the canvas a point of the floor is, `x` metres right of its middle: 0 to 1 from the left. */
async function acrossOf(page: Page, x: number): Promise<number> {
  const { width, height } = (await page.locator("#room").boundingBox())!;
  const halfHeight = DISTANCE * Math.tan((20 * Math.PI) / 180);
  return 0.5 + (x / (2 * halfHeight)) * (height / width);
}

/** Clicks on the floor's middle line, `x` metres right of its middle, and returns what the page says about that place, in the green band. */
async function readAt(page: Page, x: number): Promise<{ irradiance: number; radiosity: number; text: string }> {
  const { width, height } = (await page.locator("#room").boundingBox())!;
  await page.locator("#room").click({ position: { x: (await acrossOf(page, x)) * width, y: height / 2 } });
  await page.locator("#reading").waitFor();
  const text = (await page.locator("#reading").textContent())!;
  const number = / [\d.]+(?:e-?\d+)?, ([\d.]+(?:e-?\d+)?)/;
  const [irradiance, radiosity] = text.split("\n").slice(0, 2).map((line) => Number(number.exec(line)![1]));
  return { irradiance, radiosity, text };
}

/** Linear light of the picture 1 m left and right of the floor's middle. */
async function lightOf(page: Page): Promise<[number, number]> {
  const linear = (byte: number) => (byte / 255 <= 0.04045 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4);
  const [left, right] = await Promise.all([-1, 1].map(async (x) => linear((await pixelAt(page, await acrossOf(page, x), 0.5))[1])));
  return [left, right];
}

const ratioOf = async (page: Page) => {
  const [left, right] = await lightOf(page);
  return right / left;
};

const RATIO = LINEAR[LIGHT] / LINEAR[DARK];
// Bytes of the picture are about 100 and more: they round light by 1.1 %. The rest is for noise of the solve.
const TOLERANCE = 0.05;

const warningsOf = (page: Page) => page.locator("#warnings li").allTextContents();

describe("textures on the page", () => {
  it("are drawn texel by texel, and read so", async () => {
    const page = await show(await floor(true));
    await expect.poll(() => ratioOf(page)).toBeGreaterThan((1 - TOLERANCE) * RATIO);
    expect(await ratioOf(page)).toBeLessThan((1 + TOLERANCE) * RATIO);
    const plain = await show(await floor(false));
    await expect.poll(async () => Math.abs((await ratioOf(plain)) - 1)).toBeLessThan(TOLERANCE);
    const [textured, mean] = [await lightOf(page), await lightOf(plain)];
    expect(Math.abs(textured[0] / mean[0] / (LINEAR[DARK] / MEAN) - 1)).toBeLessThan(TOLERANCE);
    expect(Math.abs(textured[1] / mean[1] / (LINEAR[LIGHT] / MEAN) - 1)).toBeLessThan(TOLERANCE);
    expect(await warningsOf(page)).toEqual([]);

    const { irradiance, radiosity } = await readAt(page, -1);
    expect(Math.abs(radiosity / irradiance / LINEAR[DARK] - 1)).toBeLessThan(0.02); // of three digits each
    await Promise.all([page.close(), plain.close()]);
  });

  it("come after the connection was lost", async () => {
    let calls = 0;
    const page = await show(await floor(true), (opened) =>
      opened.route("**/ReadImages", (route) => (++calls === 1 ? route.abort() : route.continue())),
    );
    await expect.poll(() => ratioOf(page)).toBeGreaterThan((1 - TOLERANCE) * RATIO);
    expect(calls).toBe(2);
    expect(await warningsOf(page)).toEqual([]);
    await page.close();
  });

  it("are shown by their mean colours, and the page says so, where they cannot be read", async () => {
    const page = await show(await floor(true), (opened) => opened.route("**/ReadImages", (route) => route.fulfill({ status: 404 })));
    await expect.poll(async () => (await warningsOf(page)).join()).toContain("Textures are shown by their mean colours: ");
    expect(await warningsOf(page)).toHaveLength(1);
    expect(Math.abs((await ratioOf(page)) - 1)).toBeLessThan(TOLERANCE);
    const first = page.url();
    await page.click("#start"); // says so once, not once for each solve
    await expect.poll(() => page.url()).not.toBe(first);
    await waitForState(page, "Done");
    await expect.poll(() => warningsOf(page)).toHaveLength(1);
    await page.close();
  });

  it("leave the picture of irradiance as it is", async () => {
    const page = await show(await floor(true));
    await expect.poll(() => ratioOf(page)).toBeGreaterThan((1 - TOLERANCE) * RATIO);
    await page.selectOption("#show", "irradiance");
    await expect.poll(async () => Math.abs((await ratioOf(page)) - 1)).toBeLessThan(TOLERANCE);
    await page.close();
  });
});

// x, y, z of the corners of squares around the middle of the floor: fronts up, fronts down.
const facingUp = (half: number, y: number) => [-half, y, -half, -half, y, half, half, y, half, half, y, -half];
const facingDown = (half: number, y: number) => [-half, y, -half, half, y, -half, half, y, half, -half, y, half];

async function sceneOf(displayName: string, chunk: object): Promise<Scene> {
  return server.api.createScene([
    create(CreateSceneRequestSchema, { content: { case: "scene", value: { displayName } } }),
    create(CreateSceneRequestSchema, { content: { case: "chunk", value: chunk } }),
  ]);
}

describe("holes that an image cuts out", () => {
  /** The floor between a lamp 4 m above it and a red plate 1 m below it; its right half is a hole. */
  function halfAFloor(): Promise<Scene> {
    const texels = Array.from({ length: COLUMNS * ROWS }, (_, n) => n % COLUMNS).flatMap((column) => {
      return column < COLUMNS / 2 ? [LIGHT, LIGHT, LIGHT, 255] : [0, 0, 0, 0];
    });
    return sceneOf("half a floor", {
      materials: [
        { name: "floor", reflectance: rgb(LINEAR[LIGHT]), texture: { wrapS: Texture_Wrap.CLAMP, wrapT: Texture_Wrap.CLAMP } },
        { name: "lamp", emission: rgb(10), reflectance: rgb(0) },
        { name: "plate", emission: { r: 0.1, g: 0, b: 0 }, reflectance: rgb(0) },
      ],
      vertexCoordinates: [...facingUp(2, 0), ...facingDown(0.5, 4), ...facingUp(2, -1)],
      faceCornerCounts: [4, 4, 4],
      faceMaterials: [0, 1, 2],
      cornerVertices: Array.from({ length: 12 }, (_, n) => n),
      images: [{ columns: COLUMNS, rows: ROWS, hasOpacity: true }],
      texels: Uint8Array.from(texels),
      textureCoordinates: [0, 0, 0, 1, 1, 1, 1, 0, ...Array<number>(16).fill(0)],
    });
  }

  it("show what is behind, and a click there reads it", async () => {
    const page = await show(await halfAFloor(), undefined, 1.5, 0.1); // shadows of an edge take long
    const pixel = async (x: number) => pixelAt(page, await acrossOf(page, x), 0.5);
    await expect.poll(async () => (await pixel(1))[1]).toBeLessThan(2);
    expect((await pixel(1))[0]).toBeGreaterThan(50);
    const [r, g, b] = await pixel(-1);
    expect(Math.min(r, g, b)).toBeGreaterThan(50);
    await expect.poll(async () => (await readAt(page, 1)).text).toContain("plate");
    await expect.poll(async () => (await readAt(page, -1)).text).toContain("floor");
    await page.close();
  });
});

describe("a translucent screen", () => {
  const TAU = 0.5;
  const BELOW = 4;

  /** The floor, which reflects nothing, above a lamp: its upper side gets no light but what comes through. */
  function screen(): Promise<Scene> {
    return sceneOf("a screen", {
      materials: [
        { name: "screen", reflectance: rgb(0), diffuseTransmittance: rgb(TAU), twoSided: true },
        { name: "lamp", emission: rgb(10), reflectance: rgb(0) },
      ],
      vertexCoordinates: [...facingUp(2, 0), ...facingUp(0.5, -BELOW)],
      faceCornerCounts: [4, 4],
      faceMaterials: [0, 1],
      cornerVertices: [0, 1, 2, 3, 4, 5, 6, 7],
    });
  }

  it("is as bright as the light that comes through, and reads so", async () => {
    const page = await show(await screen(), undefined, -BELOW / 2);
    const { irradiance, radiosity, text } = await readAt(page, -1);
    expect(text).toContain("screen");
    expect(irradiance).toBe(0);
    // Of a small lamp of 1 m2, E cos^4 / (pi d^2) arrives. The lamp's size takes 1 %; a leaf is as wide as it may be at 1 %.
    const arriving = (10 / Math.PI) * (BELOW ** 2 / (BELOW ** 2 + 1) ** 2);
    expect(Math.abs(radiosity / (TAU * arriving) - 1)).toBeLessThan(0.1);
    const [r, g, b] = await pixelAt(page, await acrossOf(page, -1), 0.5);
    expect(Math.min(r, g, b)).toBeGreaterThan(50);
    await page.close();
  });
});
