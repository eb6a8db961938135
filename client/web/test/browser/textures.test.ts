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

// From above and in front of the floor, at its middle; both measured from the middle of the scene.
const EYE = "0_4_5_0_-2_0";
const DISTANCE = Math.hypot(6, 5);

/** Solves a scene and shows it, when `prepare` has had its way with the page. */
async function show(scene: Scene, prepare: (page: Page) => Promise<unknown> = async () => undefined): Promise<Page> {
  const { name } = await server.api.solves.createSolve({ parent: scene.name, solve: { spec: { tolerance: 0.01 } } });
  const page = await openPage(browser, server.url);
  await prepare(page);
  await page.evaluate((hash) => (location.hash = hash), `${name}?tone=linear&ambient=0&eye=${EYE}`);
  await waitForEnd(page, name);
  return page;
}

/** Returns where on the canvas a point of the floor is, `x` metres right of its middle: 0 to 1 from the left. */
async function acrossOf(page: Page, x: number): Promise<number> {
  const { width, height } = (await page.locator("#room").boundingBox())!;
  const halfHeight = DISTANCE * Math.tan((20 * Math.PI) / 180);
  return 0.5 + (x / (2 * halfHeight)) * (height / width);
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

    const { width, height } = (await page.locator("#room").boundingBox())!;
    await page.locator("#room").click({ position: { x: (await acrossOf(page, -1)) * width, y: height / 2 } });
    await page.locator("#reading").waitFor();
    const lines = (await page.locator("#reading").textContent())!.split("\n");
    const [irradiance, radiosity] = lines.slice(0, 2).map((line) => Number(/ ([\d.]+(e-?\d+)?)/.exec(line)![1]));
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
