import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { Solve_State } from "../../src/gen/alvor/v1/solve_service_pb";
import { createScene, Server } from "./server";
import { meanBrightness, measuredBy, openBrowser, openPage, pixelAt, stateOf, waitForEnd, waitForFrames, waitForState, type Page } from "./viewer";

const SCENES = new URL("../../../../scenes/", import.meta.url);
const scene = (name: string) => new URL(name, SCENES).pathname;
const CORNELL = [scene("cornell_box.obj"), scene("cornell_box.mtl")];

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

/** A solve of the Cornell box that waits after each step, so that a test can look between them. */
async function slowSolve(pauseMs: number): Promise<string> {
  const page = await openPage(browser, server.url);
  await page.setInputFiles("#files", CORNELL);
  await waitForState(page, "Done");
  await page.close();
  const stored = (await server.api.scenes.listScenes({})).scenes[0];
  const stepPause = { seconds: BigInt(Math.floor(pauseMs / 1000)), nanos: (pauseMs % 1000) * 1_000_000 };
  return (await server.api.solves.createSolve({ parent: stored.name, solve: { spec: { tolerance: 0.015, stepPause } } })).name;
}

// Where things are in the first view of the Cornell box.
const LAMP = [0.5, 0.15] as const;
const RED_WALL = [0.32, 0.35] as const;
const GREEN_WALL = [0.68, 0.35] as const;
const BACK_WALL = [0.53, 0.35] as const;

/** What the state says may be drawn a moment later, where the processor draws. */
const waitForLamp = (page: Page) =>
  expect.poll(async () => Math.min(...(await pixelAt(page, ...LAMP))), { timeout: 20_000, interval: 100 }).toBeGreaterThan(250);

describe("the page", () => {
  it("solves what is dropped, and shows it as it is lit", async () => {
    const page = await openPage(browser, server.url);
    await page.setInputFiles("#files", CORNELL);
    await waitForState(page, "Done: tolerance reached");
    await waitForLamp(page);
    const [lamp, red, green, back] = await Promise.all([LAMP, RED_WALL, GREEN_WALL, BACK_WALL].map(([x, y]) => pixelAt(page, x, y)));
    expect(red[0]).toBeGreaterThan(2 * Math.max(red[1], red[2]));
    expect(green[1]).toBeGreaterThan(1.3 * Math.max(green[0], green[2]));
    expect(Math.min(...back)).toBeGreaterThan(100);
    expect(Math.max(...back)).toBeLessThan(Math.min(...lamp));
    // Red light on the white wall beside the red one, green beside the green one.
    const [nearRed, nearGreen] = await Promise.all([pixelAt(page, 0.385, 0.5), pixelAt(page, 0.62, 0.5)]);
    expect(nearRed[0] / nearRed[1]).toBeGreaterThan(nearGreen[0] / nearGreen[1]);
    await page.close();
  });

  it("brightens from direct light to the end of the solve, and shows the same to everyone who has its address", async () => {
    const slow = await slowSolve(5000); // stays long at its first steps, of which one may be dark
    const page = await openPage(browser, `${server.url}#${slow}`);
    await page.uncheck("#ambient");
    await expect.poll(() => meanBrightness(page)).toBeGreaterThan(5);
    await page.uncheck("#automatic");
    const before = await meanBrightness(page);
    await server.api.solves.cancelSolve({ name: slow });
    const quick = await slowSolve(0);
    await page.evaluate((name) => (location.hash = name), quick);
    await waitForEnd(page, quick);
    expect(await meanBrightness(page)).toBeGreaterThan(1.02 * before);
    await page.check("#automatic");
    await page.check("#ambient");
    const other = await openPage(browser, `${server.url}#${quick}`);
    await waitForEnd(other, quick);
    await expect.poll(async () => Math.abs((await meanBrightness(page)) - (await meanBrightness(other)))).toBeLessThan(0.5);
    await Promise.all([page.close(), other.close()]);
  });

  it("reads a surface where it is clicked", async () => {
    const page = await openPage(browser, server.url);
    await page.setInputFiles("#files", CORNELL);
    await waitForState(page, "Done");
    const box = (await page.locator("#room").boundingBox())!;
    await page.locator("#room").click({ position: { x: RED_WALL[0] * box.width, y: RED_WALL[1] * box.height } });
    const reading = page.locator("#reading");
    await reading.waitFor();
    expect(await reading.textContent()).toMatch(/^Irradiance [\d.]+, [\d.]+, [\d.]+ W\/m²\nRadiosity .*\nFace \d+, level \d+, red/);
    await page.close();
  });

  it("shows irradiance in false colours, with a legend in either unit", async () => {
    const page = await openPage(browser, server.url);
    await page.setInputFiles("#files", CORNELL);
    await waitForState(page, "Done");
    const room = await pixelAt(page, ...RED_WALL);
    await page.selectOption("#show", "irradiance");
    const top = page.locator("#legend-ticks li").first();
    await top.waitFor();
    const watts = Number(await top.textContent());
    expect(watts).toBeGreaterThan(0);
    await page.selectOption("#unit", "lx");
    await expect.poll(async () => Number(await top.textContent()) / watts).toBeCloseTo(179, -1);
    expect(await pixelAt(page, ...RED_WALL)).not.toEqual(room);
    await page.close();
  });

  it("pauses, resumes and cancels", async () => {
    const name = await slowSolve(1500);
    const page = await openPage(browser, `${server.url}#${name}`);
    await waitForFrames(page, 1);
    await page.click("#pause");
    await waitForState(page, "Paused");
    await page.click("#pause");
    await page.locator("#pause", { hasText: "Pause" }).waitFor();
    await page.click("#cancel");
    await waitForState(page, "Cancelled");
    expect((await server.api.solves.getSolve({ name })).state).toBe(Solve_State.CANCELLED);
    await page.close();
  });

  it("says what is wrong with a file, and where", async () => {
    const page = await openPage(browser, server.url);
    const file = (name: string, text: string) => ({ name, mimeType: "text/plain", buffer: Buffer.from(text) });
    const triangle = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl white\nf 1 2 3\n";
    await page.setInputFiles("#files", [file("empty.obj", "v 0 0 0\n")]);
    await waitForState(page, "empty.obj: has no faces");
    await page.setInputFiles("#files", [file("a.obj", triangle), file("a.mtl", "newmtl white\nKd 1.5 1 1\n")]);
    await waitForState(page, "material 0 'white': reflectance 1.5 is outside [0, 1)");
    await page.setInputFiles("#files", [file("picture.png", "")]);
    await waitForState(page, "No OBJ or GLB among these files");
    await page.setInputFiles("#files", [file("room.glb", "glTF but no more")]);
    await waitForState(page, "room.glb: ");
    await page.close();
  });

  it("gives what it shows to take home, as files that it can read", async () => {
    const page = await openPage(browser, server.url);
    await page.setInputFiles("#files", CORNELL);
    await waitForState(page, "Done");
    const save = async (id: string) => {
      const [download] = await Promise.all([page.waitForEvent("download"), page.click(id)]);
      return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
    };
    const [glb, png, report] = [await save("#save-glb"), await save("#save-png"), await save("#save-report")];
    expect(glb.bytes.subarray(0, 4).toString()).toBe("glTF");
    expect(png.bytes.subarray(1, 4).toString()).toBe("PNG");
    const lines = report.bytes.toString().trim().split("\n");
    expect(lines[0]).toBe("elapsed_s,step,shots,rays,leaves,unshot_fraction,estimated_error");
    expect(Number(lines.at(-1)!.split(",")[6])).toBeLessThan(0.02);
    await page.setInputFiles("#files", { name: glb.name, mimeType: "model/gltf-binary", buffer: glb.bytes });
    // It was read and sent; but it is a solution, of light and not of reflectance.
    await waitForState(page, "reflectance 1 is outside [0, 1)");
    await page.close();
  });

  it("goes on by itself after the server was killed", async () => {
    const name = await slowSolve(600);
    const page = await openPage(browser, `${server.url}#${name}`);
    await waitForFrames(page, 2);
    await server.kill();
    await waitForState(page, "Connection lost");
    await server.start();
    await waitForState(page, "Connected again");
    await waitForState(page, "Done: tolerance reached");
    await waitForLamp(page);
    await page.close();
  });

  it("shows a hundred thousand leaves, and stays a page", async () => {
    const side = 317;
    const tile = (n: number): [number, number, number][] => {
      const [x, z] = [n % side, Math.floor(n / side)];
      return [[x, 0, z], [x, 0, z + 1], [x + 1, 0, z + 1], [x + 1, 0, z]];
    };
    const floor = Array.from({ length: side * side }, (_, n) => ({ corners: tile(n), reflectance: [0.5, 0.5, 0.5] as [number, number, number] }));
    const [low, high] = [0.3 * side, 0.7 * side];
    const lamp = {
      corners: [[low, 90, low], [high, 90, low], [high, 90, high], [low, 90, high]] as [number, number, number][],
      emission: [1000, 1000, 1000] as [number, number, number],
    };
    const stored = await createScene(server.api, [...floor, lamp]);
    const { name } = await server.api.solves.createSolve({ parent: stored.name, solve: { spec: { maxDepth: 0, tolerance: 0.05 } } });
    const page = await openPage(browser, `${server.url}#${name}`);
    await page.waitForFunction(() => (window as unknown as { alvor: { slots: number } }).alvor.slots > 100_000);
    await waitForState(page, "Done");
    const before = await meanBrightness(page);
    expect(before).toBeGreaterThan(1);
    const box = (await page.locator("#room").boundingBox())!;
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + 80, box.y + box.height / 2 + 120, { steps: 4 });
    await page.mouse.up();
    await expect.poll(() => meanBrightness(page)).not.toBe(before);
    console.log("100 k leaves:", JSON.stringify(await measuredBy(page)));
    await page.close();
  });

  it.each(["light", "dark"] as const)("can be used by everyone, in %s too", async (colorScheme) => {
    const page = await openPage(browser, server.url);
    await page.emulateMedia({ colorScheme });
    await page.setInputFiles("#files", CORNELL);
    await waitForState(page, "Done");
    const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
    await page.evaluate(axe);
    const { violations } = await page.evaluate(() =>
      (window as unknown as { axe: { run(): Promise<{ violations: { id: string; impact: string; nodes: { html: string }[] }[] }> } }).axe.run(),
    );
    const serious = violations.filter(({ impact }) => impact === "serious" || impact === "critical");
    expect(serious.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join("; ")}`)).toEqual([]);
    await page.close();
  });

  it("is worked by the keyboard alone", async () => {
    const page = await openPage(browser, server.url);
    await page.locator("#examples").focus();
    await page.keyboard.press("ArrowDown");
    await waitForState(page, "Done");
    const first = page.url();
    await page.locator("#start").focus();
    await page.keyboard.press("Enter");
    await expect.poll(() => page.url()).not.toBe(first);
    await waitForState(page, "Done");
    await page.locator("#room").focus();
    await page.keyboard.press("Enter");
    await page.locator("#reading").waitFor();
    expect(await stateOf(page)).toContain("Done");
    await page.close();
  });

  it.each([
    [1280, 720],
    [800, 1100],
  ])("fits a screen of %d x %d", async (width, height) => {
    const page: Page = await openPage(browser, server.url, { width, height });
    await page.setInputFiles("#files", CORNELL);
    await waitForState(page, "Done");
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    expect(wide).toBeLessThanOrEqual(width);
    expect((await page.locator("#room").boundingBox())!.height).toBeGreaterThan(300);
    await page.close();
  });
});
