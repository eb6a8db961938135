import { copyFileSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { Light_Kind, type Material } from "../../src/gen/alvor/v1/scene_service_pb";
import { Solve_State } from "../../src/gen/alvor/v1/solve_service_pb";
import { createScene, Server } from "./server";
import { meanBrightness, measuredBy, obstacles, openBrowser, openPage, pauseSeenBy, pixelAt, stateOf, waitForEnd, waitForFrames, waitForState, watchPause, type Page } from "./viewer";

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

const BLENDER = new URL("../../../../tests/import/blender/files/", import.meta.url).pathname;
const ROOM_PARTS = ["room.bin", "floor_checker.png", "leaf.png", "screen.png", "wall paper.png", "wood.png"];

const solveOf = (url: string) => url.slice(url.indexOf("#") + 1).split("?")[0];
const warningsOf = (page: Page) => page.locator("#warnings li").allTextContents();

async function materialsOf(name: string): Promise<Material[]> {
  const materials: Material[] = [];
  for await (const { chunk } of server.api.scenes.readScene({ name })) materials.push(...chunk!.materials);
  return materials;
}

/** The kinds of a scene's lights that are not faces. */
async function lampsOf(name: string): Promise<Light_Kind[]> {
  const kinds: Light_Kind[] = [];
  for await (const { chunk } of server.api.scenes.readScene({ name })) kinds.push(...chunk!.lights.map(({ kind }) => kind));
  return kinds;
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
    expect(await reading.textContent()).toMatch(/^Irradiance [\d.]+, [\d.]+, [\d.]+ ± [\d.]+ W\/m²\nRadiosity .*\nFace \d+, level \d+, red/);
    await page.close();
  });

  it("shows irradiance and its error in false colours, with a legend in the unit of the scene", async () => {
    const page = await openPage(browser, server.url);
    await page.setInputFiles("#files", CORNELL);
    await waitForState(page, "Done");
    const room = await pixelAt(page, ...RED_WALL);
    await page.selectOption("#show", "irradiance");
    const top = page.locator("#legend-ticks li").first();
    await top.waitFor();
    const watts = Number(await top.textContent());
    expect(watts).toBeGreaterThan(0);
    expect(await page.locator("#legend-title").textContent()).toBe("Irradiance, W/m²");
    const coloured = await pixelAt(page, ...RED_WALL);
    expect(coloured).not.toEqual(room);
    await page.selectOption("#show", "error");
    await expect.poll(() => page.locator("#legend-title").textContent()).toBe("Error of irradiance, W/m²");
    expect(Number(await top.textContent())).toBeGreaterThan(0);
    expect(Number(await top.textContent())).toBeLessThan(watts / 5);
    expect(await pixelAt(page, ...RED_WALL)).not.toEqual(coloured);
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

  it("pauses at once", async () => {
    const page = await openPage(browser, server.url);
    await page.fill("#tolerance", "0.05");
    await page.setInputFiles("#files", [scene("furnished_room.obj"), scene("furnished_room.mtl")]);
    await waitForFrames(page, 1);
    await page.evaluate(watchPause);
    await page.click("#pause");
    await waitForState(page, "Paused");
    const { said, paused } = await pauseSeenBy(page);
    expect(said).toBeLessThan(100);
    expect(paused).toBeLessThan(5000); // a fraction of a second where nothing else runs: docs/page.md
    await page.click("#pause");
    await waitForState(page, "Solving");
    await page.click("#cancel");
    await waitForState(page, "Cancelled");
    await page.close();
  });

  it("shows no answer that a later one has overtaken", async () => {
    const name = await slowSolve(1500);
    const page = await openPage(browser, `${server.url}#${name}`);
    await waitForFrames(page, 1);
    let isHeldUp = false;
    await page.route("**/GetSolve", async (route) => {
      const response = await route.fetch();
      if (!isHeldUp) {
        isHeldUp = true;
        await page.waitForTimeout(2500);
      }
      await route.fulfill({ response });
    });
    await expect.poll(() => isHeldUp).toBe(true);
    await page.click("#pause");
    await waitForState(page, "Paused");
    const said = await page.evaluate(async () => {
      const all: string[] = [];
      const state = document.getElementById("state")!;
      new MutationObserver(() => all.push(state.textContent!)).observe(state, { childList: true });
      await new Promise((resolve) => setTimeout(resolve, 3000));
      return all;
    });
    expect(said).toEqual([]);
    await server.api.solves.cancelSolve({ name });
    await page.unrouteAll({ behavior: "ignoreErrors" }); // an answer may still be held up
    await page.close();
  });

  it("cancels the solve that it began when another is started", async () => {
    const page = await openPage(browser, server.url);
    await page.fill("#tolerance", "0.05");
    await page.setInputFiles("#files", [scene("furnished_room.obj"), scene("furnished_room.mtl")]);
    await waitForFrames(page, 1);
    const first = solveOf(page.url());
    await page.fill("#tolerance", "20");
    await page.click("#start");
    await expect.poll(() => solveOf(page.url())).not.toBe(first);
    await waitForState(page, "Done");
    await expect.poll(async () => (await server.api.solves.getSolve({ name: first })).state).toBe(Solve_State.CANCELLED);
    await page.close();
  });

  it("leaves a solve alone that another began", async () => {
    const name = await slowSolve(20_000);
    const page = await openPage(browser, `${server.url}#${name}`);
    await waitForFrames(page, 1);
    await page.click("#start");
    await expect.poll(() => solveOf(page.url())).not.toBe(name);
    expect((await server.api.solves.getSolve({ name })).state).not.toBe(Solve_State.CANCELLED);
    await server.api.solves.cancelSolve({ name });
    await page.close();
  });

  it("has an address that shows others the same view", async () => {
    const page = await openPage(browser, server.url);
    await page.setInputFiles("#files", CORNELL);
    await waitForState(page, "Done");
    await waitForLamp(page);
    const solve = solveOf(page.url());
    await page.selectOption("#tone", "reinhard");
    await page.check("#mesh");
    await page.locator("#exposure").fill("1.5");
    await page.uncheck("#automatic");
    const box = (await page.locator("#room").boundingBox())!;
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + 90, box.y + box.height / 2 + 40, { steps: 4 });
    await page.mouse.up();
    await page.locator("#reading").waitFor({ state: "hidden" });
    await expect.poll(() => page.url()).toMatch(/\?.*tone=reinhard.*mesh=1.*held=.*eye=/);
    await page.waitForTimeout(600); // until the address is at rest
    const other = await openPage(browser, page.url());
    await waitForEnd(other, solve);
    expect(await other.locator("#tone").inputValue()).toBe("reinhard");
    expect(await other.locator("#exposure-stops").textContent()).toBe("1.5 EV");
    const points = [[0.3, 0.4], [0.5, 0.3], [0.5, 0.7], [0.7, 0.5]] as const;
    const seenBy = async (tab: Page) => (await Promise.all(points.map(([x, y]) => pixelAt(tab, x, y)))).flat();
    const seen = await seenBy(page);
    await expect.poll(async () => Math.max(...(await seenBy(other)).map((x, n) => Math.abs(x - seen[n])))).toBeLessThan(3);
    expect(other.url()).toBe(page.url());
    await Promise.all([page.close(), other.close()]);
  });

  it("reads room.gltf with its parts, and JPEG textures", async () => {
    const page = await openPage(browser, server.url);
    await page.fill("#tolerance", "20");
    await page.setInputFiles("#files", ["room.gltf", ...ROOM_PARTS].map((part) => BLENDER + part));
    await waitForState(page, "Done");
    expect(await page.locator("#title").textContent()).toBe("room.gltf, 1557 faces");
    expect(await warningsOf(page)).toContain("1 clear material is taken for thin panes, without refraction");
    expect(await lampsOf((await server.api.scenes.listScenes({})).scenes[0].name)).toEqual([Light_Kind.POINT, Light_Kind.SPOT, Light_Kind.DIRECTIONAL]);
    const jpeg = await page.evaluate(async () => {
      const canvas = new OffscreenCanvas(1500, 40); // wider than what is looked at in one piece
      const pen = canvas.getContext("2d")!;
      pen.fillStyle = "rgb(128, 255, 0)";
      pen.fillRect(0, 0, 1500, 40);
      return [...new Uint8Array(await (await canvas.convertToBlob({ type: "image/jpeg", quality: 1 })).arrayBuffer())];
    });
    const obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl painted\nf 1 2 3\n";
    const file = (name: string, content: string | number[]) => ({ name, mimeType: "", buffer: Buffer.from(content as string) });
    await page.setInputFiles("#files", [file("a.obj", obj), file("a.mtl", "newmtl painted\nKd 0.5 0.5 0.5\nmap_Kd a.jpg\n"), file("a.jpg", jpeg)]);
    await expect.poll(async () => (await server.api.scenes.listScenes({})).scenes[0].displayName).toBe("a.obj");
    const stored = (await server.api.scenes.listScenes({})).scenes[0];
    const [painted] = await materialsOf(stored.name);
    expect(painted.reflectance!.r).toBeCloseTo(0.5 * 0.2159, 2);
    expect(painted.reflectance!.g).toBeCloseTo(0.5, 2);
    expect(painted.reflectance!.b).toBeCloseTo(0, 2);
    await page.close();
  });

  it("takes a folder that is dropped, with parts in folders of their own", async () => {
    const folder = mkdtempSync(join(tmpdir(), "room-"));
    mkdirSync(join(folder, "parts"));
    const text = readFileSync(`${BLENDER}room.gltf`, "utf8").replace('"room.bin"', '"parts/room.bin"').replace(/"([\w%]+\.png)"/g, '"parts/$1"');
    writeFileSync(join(folder, "room.gltf"), text);
    for (const part of ROOM_PARTS) copyFileSync(BLENDER + part, join(folder, "parts", part));
    const page = await openPage(browser, server.url);
    await page.fill("#tolerance", "20");
    const session = await page.context().newCDPSession(page);
    const data = { items: [], files: [folder], dragOperationsMask: 1 };
    for (const type of ["dragEnter", "dragOver", "drop"] as const) await session.send("Input.dispatchDragEvent", { type, x: 300, y: 300, data });
    await page.locator("#title", { hasText: "room.gltf, 1557 faces" }).waitFor();
    await waitForState(page, "Done");
    await page.close();
    rmSync(folder, { recursive: true });
  });

  it("shows a file of z up upright", async () => {
    const page = await openPage(browser, server.url);
    await page.setInputFiles("#files", [`${BLENDER}room.stl`]);
    await waitForState(page, "Done");
    expect(await page.locator("#title").textContent()).toBe("room.stl, 767 faces");
    // A pillar of 1 x 1 x 8 m stands: its picture is higher than wide.
    const pillar = (x: number, y: number) => `v ${x} ${y} 0\nv ${x} ${y} 8\n`;
    const ply = `ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n${pillar(0, 0)}${pillar(1, 0)}${pillar(1, 1)}${pillar(0, 1)}`.replaceAll("v ", "") + "4 0 2 3 1\n4 2 4 5 3\n4 4 6 7 5\n4 6 0 1 7\n4 0 6 4 2\n4 1 3 5 7\n";
    await page.setInputFiles("#files", { name: "pillar.ply", mimeType: "", buffer: Buffer.from(ply) });
    await page.locator("#title", { hasText: "pillar.ply, 6 faces" }).waitFor();
    await waitForFrames(page, 1);
    const alphaAt = (x: number, y: number) =>
      page.evaluate(([u, v]) => {
        const canvas = document.getElementById("room") as HTMLCanvasElement;
        const copy = document.createElement("canvas");
        copy.width = copy.height = 1;
        const pen = copy.getContext("2d")!;
        pen.drawImage(canvas, -u * canvas.width, -v * canvas.height);
        return pen.getImageData(0, 0, 1, 1).data[3];
      }, [x, y]);
    await expect.poll(() => Promise.all([alphaAt(0.5, 0.1), alphaAt(0.5, 0.9), alphaAt(0.35, 0.5), alphaAt(0.65, 0.5)])).toEqual([255, 255, 0, 0]);
    const box = (await page.locator("#room").boundingBox())!;
    await page.locator("#room").click({ position: { x: 0.5 * box.width, y: 0.15 * box.height } });
    await page.locator("#reading").waitFor();
    const [, , z] = /at (.*), (.*), (.*) m/.exec((await page.locator("#reading").textContent())!)!.slice(1).map(Number);
    expect(z).toBeGreaterThan(6);
    await page.close();
  });

  it("says what is wrong with a file, and where", async () => {
    const page = await openPage(browser, server.url);
    await page.fill("#tolerance", "20");
    const file = (name: string, text: string) => ({ name, mimeType: "text/plain", buffer: Buffer.from(text) });
    const triangle = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl white\nf 1 2 3\n";
    await page.setInputFiles("#files", [file("empty.obj", "v 0 0 0\n")]);
    await waitForState(page, "empty.obj: scene: has no faces");
    await page.setInputFiles("#files", [file("a.obj", triangle), file("a.mtl", "newmtl white\nKd 1.5 1 1\n")]);
    await waitForState(page, "Done");
    await expect.poll(() => warningsOf(page)).toContain("material 'white': reflectance 1.5 1 1 is clamped to 0.95 0.95 0.95");
    await page.setInputFiles("#files", [file("picture.png", "")]);
    await waitForState(page, "No scene among these files: picture.png");
    await page.setInputFiles("#files", [file("room.glb", "glTF but no more")]);
    await waitForState(page, "room.glb: file: is GLB of version");
    await page.setInputFiles("#files", [`${BLENDER}room.gltf`]);
    await waitForState(page, "room.gltf needs floor_checker.png, leaf.png, room.bin, screen.png, ");
    await page.setInputFiles("#files", [file("notes.txt", "")]);
    await waitForState(page, "room.gltf needs floor_checker.png, leaf.png, room.bin, screen.png, ");
    await page.setInputFiles("#files", ROOM_PARTS.map((part) => BLENDER + part));
    await waitForState(page, "Done");
    await page.setInputFiles("#files", [file("a.obj", triangle)]);
    await waitForState(page, "a.obj needs a.mtl, which was not dropped with it");
    await page.locator("#without-parts").click();
    await waitForState(page, "Done");
    await expect.poll(() => warningsOf(page)).toContain("material library 'a.mtl' cannot be read");
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
    // It was read and sent; but it is a solution, of light and not of lamps.
    await page.locator("#title", { hasText: "room.glb, " }).waitFor();
    await expect.poll(() => warningsOf(page)).toContain("material '0': reflectance 1 1 1 is clamped to 0.95 0.95 0.95");
    await waitForState(page, "Done");
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
    // The note goes away by itself.
    await page.locator("#state", { hasNotText: "Connected again" }).waitFor({ timeout: 6000 });
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
    expect(await obstacles(page)).toEqual([]);
    await page.close();
  });

  it("is worked by the keyboard alone", async () => {
    const page = await openPage(browser, server.url);
    const countScenes = async () => (await server.api.scenes.listScenes({ pageSize: 1000 })).scenes.length;
    const before = await countScenes();
    await page.locator("#examples").focus();
    for (let n = 0; n < 3; ++n) await page.keyboard.press("ArrowDown");
    for (let n = 0; n < 2; ++n) await page.keyboard.press("ArrowUp");
    await page.waitForTimeout(500);
    expect(await page.locator("#examples").inputValue()).toBe("cornell_box");
    expect(await countScenes()).toBe(before);
    expect(await stateOf(page)).toContain("Drop a scene");
    await page.keyboard.press("Enter");
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
