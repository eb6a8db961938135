import { readFile } from "node:fs/promises";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { Server } from "./server";
import { obstacles, openBrowser, openPage, pixelAt, waitForEnd, waitForState, type Page } from "./viewer";

const SCENES = new URL("../../../../scenes/", import.meta.url);
const CORNELL = ["cornell_box.obj", "cornell_box.mtl"].map((name) => new URL(name, SCENES).pathname);
const RED_WALL = [0.32, 0.35] as const;
const BACK_WALL = [0.53, 0.35] as const;
const BLOCK = [0.45, 0.6] as const;
/** On the low block, near its foot: where the block has risen by half of its height, the floor is seen there. */
const FOOT = [0.5, 0.8] as const;

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

/** The Cornell box with its blocks as an object. */
async function withBlocks() {
  const lines = (await readFile(CORNELL[0], "utf8")).split("\n");
  lines.splice(lines.findLastIndex((line) => line.startsWith("usemtl")), 0, "o blocks");
  const material = { name: "cornell_box.mtl", mimeType: "model/mtl", buffer: await readFile(CORNELL[1]) };
  return [{ name: "blocks.obj", mimeType: "model/obj", buffer: Buffer.from(lines.join("\n")) }, material];
}

/** Two who watch one solve that has ended. Its tolerance is wide, because pages whose pictures the processor draws need few leaves. */
async function two(files: Parameters<Page["setInputFiles"]>[1] = CORNELL): Promise<{ name: string; ann: Page; ben: Page }> {
  const ann = await openPage(browser, server.url);
  await ann.fill("#tolerance", "10");
  await ann.setInputFiles("#files", files);
  await waitForState(ann, "Done");
  const name = new URL(ann.url()).hash.slice(1).split("?")[0];
  const ben = await openPage(browser, `${server.url}#${name}`);
  await waitForEnd(ben, name);
  await ann.fill("#edit-author", "Ann");
  return { name, ann, ben };
}

const click = async (page: Page, [x, y]: readonly [number, number]) => {
  const box = (await page.locator("#room").boundingBox())!;
  await page.locator("#room").click({ position: { x: x * box.width, y: y * box.height } });
};
/** Clicks at a part of the room, and waits until the page has read it and chosen it: the list may name a part that nobody has chosen yet. */
const choose = async (page: Page, at: readonly [number, number], part: string) => {
  await page.focus("#room");
  await page.keyboard.press("Escape"); // so that no reading is shown
  await page.locator(`#edit-part option[value="${part}"]`).waitFor({ state: "attached" });
  await click(page, at);
  await page.locator("#reading").waitFor();
  expect(await page.inputValue("#edit-part")).toBe(part);
};
const slide = (page: Page, id: string, value: string) =>
  page.locator(id).evaluate((control, to) => {
    (control as HTMLInputElement).value = to;
    control.dispatchEvent(new Event("input", { bubbles: true }));
  }, value);
const redness = async (page: Page) => {
  const [r, , b] = await pixelAt(page, ...RED_WALL);
  return r - b;
};

describe("edits on the page", () => {
  it("are seen by everyone, with who made them, and taken back", async () => {
    const { name, ann, ben } = await two();
    await choose(ann, RED_WALL, "material:red");
    expect(await redness(ben)).toBeGreaterThan(50);
    await slide(ann, "#edit-colour", "#3050e0");
    for (const page of [ann, ben]) await expect.poll(() => redness(page)).toBeLessThan(-50);
    await expect.poll(() => ben.textContent("#edit-news")).toBe("Ann edited red");
    await waitForState(ben, "Done");
    await ben.click("#undo");
    for (const page of [ann, ben]) await expect.poll(() => redness(page)).toBeGreaterThan(50);
    await expect.poll(() => ann.textContent("#edit-news")).toBe("Somebody took the last edit back");
    await expect.poll(() => ann.isEnabled("#redo")).toBe(true);
    expect((await server.api.solves.getSolve({ name })).edits).toHaveLength(2);
    await Promise.all([ann.close(), ben.close()]);
  });

  it("dim a lamp with a slider, which is one step, by keys, too", async () => {
    const { name, ann, ben } = await two();
    await ben.uncheck("#automatic");
    const before = (await pixelAt(ben, ...BACK_WALL))[1];
    await ann.selectOption("#edit-part", "material:light");
    for (const value of ["0.9", "0.7", "0.5", "0.3"]) await slide(ann, "#edit-dim", value);
    await expect.poll(async () => (await pixelAt(ben, ...BACK_WALL))[1]).toBeLessThan(0.85 * before);
    await ann.focus("#edit-dim");
    await ann.keyboard.press("ArrowRight");
    const edited = async () => (await server.api.solves.getSolve({ name })).edits.at(-1)!.edits[0].part;
    await expect.poll(edited).toMatchObject({ case: "material", value: { name: "light" } });
    await waitForState(ann, "Done");
    expect((await server.api.solves.getSolve({ name })).edits).toHaveLength(1);
    await ann.click("#undo");
    await expect.poll(async () => (await pixelAt(ben, ...BACK_WALL))[1]).toBeGreaterThan(0.95 * before);
    await Promise.all([ann.close(), ben.close()]);
  });

  it("give a lamp of faces another colour, which keeps its brightness and is kept while it is off", async () => {
    const { name, ann, ben } = await two();
    await ben.uncheck("#automatic");
    const blueness = async () => {
      const [r, , b] = await pixelAt(ben, ...BACK_WALL);
      return b - r;
    };
    const emission = async () => {
      const last = (await server.api.solves.getSolve({ name })).edits.at(-1)?.edits[0]?.part;
      return last?.case === "material" ? last.value.emission : undefined;
    };
    await ann.selectOption("#edit-part", "material:light");
    await slide(ann, "#edit-dim", "0.5");
    await expect.poll(emission).toBeDefined();
    const { r, g, b } = (await emission())!;
    const half = Math.max(r, g, b);
    await slide(ann, "#edit-dim", "0.25");
    await slide(ann, "#edit-colour", "#3050e0"); // before the brightness was answered
    await expect.poll(blueness).toBeGreaterThan(15);
    await expect.poll(async () => (await emission())!.b).toBeCloseTo(half / 2, 3);
    expect((await emission())!.r).toBeLessThan(0.1 * half);
    for (const value of ["0.1", "0", "0.5"]) await slide(ann, "#edit-dim", value);
    await expect.poll(async () => (await emission())!.b).toBeCloseTo(half, 3);
    expect((await emission())!.r).toBeLessThan(0.1 * half);
    await waitForState(ann, "Done");
    expect((await server.api.solves.getSolve({ name })).edits).toHaveLength(3); // brightness, colour, brightness
    await ann.click("#undo");
    await expect.poll(() => ann.inputValue("#edit-dim")).toBe("0.25");
    await ann.click("#undo");
    await expect.poll(blueness).toBeLessThan(0);
    await ben.focus("#redo");
    await ben.keyboard.press("Enter");
    await expect.poll(blueness).toBeGreaterThan(15);
    await Promise.all([ann.close(), ben.close()]);
  });

  it("can be made by everyone: of objects, lamps, sun and sky", async () => {
    const { ann, ben } = await two(await withBlocks());
    for (const part of ["object:blocks", "material:light", "material:red", "daylight:"]) {
      await ann.selectOption("#edit-part", part);
      expect(await obstacles(ann), part).toEqual([]);
    }
    await Promise.all([ann.close(), ben.close()]);
  });

  it("move and hide objects, and bring them back", async () => {
    const { name, ann, ben } = await two(await withBlocks());
    await ben.uncheck("#automatic");
    const foot = () => pixelAt(ben, ...FOOT);
    const isAs = async (other: number[]) => Math.max(...(await foot()).map((value, n) => Math.abs(value - other[n]))) < 12;
    const before = [...(await foot())];
    await choose(ann, BLOCK, "object:blocks");
    await ann.check("#edit-hidden");
    await expect.poll(() => isAs(before)).toBe(false);
    await expect.poll(() => ben.textContent("#edit-news")).toBe("Ann edited blocks, taken away");
    await waitForState(ben, "Done");
    await ann.uncheck("#edit-hidden");
    await expect.poll(() => isAs(before)).toBe(true);
    await ann.fill("#edit-y", "150"); // of 550: below the ceiling, which the higher block would cross from 219 on
    await ann.keyboard.press("ArrowUp");
    await expect.poll(() => isAs(before)).toBe(false);
    await waitForState(ann, "Done");
    await ben.click("#undo");
    await expect.poll(() => isAs(before)).toBe(true);
    expect((await server.api.solves.getSolve({ name })).edits).toHaveLength(4);
    await Promise.all([ann.close(), ben.close()]);
  });

  it("drag an object across the floor, or up, and nudge it by keys; the camera stays", async () => {
    const { name, ann, ben } = await two(await withBlocks());
    const moves = async () =>
      (await server.api.solves.getSolve({ name })).edits.map(({ edits }) => {
        const { part } = edits[0];
        return part.case === "object" ? part.value.move! : undefined;
      });
    const drag = async (from: readonly [number, number], dx: number, dy: number) => {
      const box = (await ann.locator("#room").boundingBox())!;
      const at = (part: number) => [box.x + (from[0] + part * dx) * box.width, box.y + (from[1] + part * dy) * box.height] as const;
      await ann.mouse.move(...at(0));
      await ann.mouse.down();
      for (const part of [0.3, 0.7, 1]) await ann.mouse.move(...at(part));
      await ann.mouse.up();
    };
    await choose(ann, BLOCK, "object:blocks");
    await drag(BLOCK, 0.1, 0);
    await expect.poll(async () => Math.abs(Number(await ann.inputValue("#edit-x")))).toBeGreaterThan(30);
    const x = Number(await ann.inputValue("#edit-x"));
    await expect.poll(async () => Math.abs((await moves()).at(-1)!.x - x)).toBeLessThan(1e-3);
    await ann.keyboard.down("Shift");
    await drag([BLOCK[0] + 0.1, BLOCK[1]], 0, -0.1);
    await ann.keyboard.up("Shift");
    await expect.poll(async () => (await moves()).at(-1)?.y).toBeGreaterThan(30);
    await expect.poll(async () => Math.abs((await moves()).at(-1)!.y - Number(await ann.inputValue("#edit-y")))).toBeLessThan(1e-3); // all of it was sent
    const [, lifted] = await moves();
    expect(lifted!.x).toBeCloseTo(x, 2);
    await ann.focus("#room");
    await ann.keyboard.press("Alt+ArrowLeft");
    await expect.poll(async () => (await moves()).length).toBe(3);
    const [, , nudged] = await moves();
    expect(Math.abs(nudged!.x - x)).toBeCloseTo(0.02 * 559, 0); // of the extent
    expect(Math.sign(nudged!.x - x)).toBe(-Math.sign(x));
    expect(nudged!.y).toBeCloseTo(lifted!.y, 6);
    expect(new URL(ann.url()).hash.slice(1)).toBe(name); // no camera in it
    await expect.poll(() => ben.textContent("#edit-news")).toBe("Ann edited blocks, moved");
    for (let step = 0; step < 3; ++step) await ben.click("#undo");
    await expect.poll(async () => Number(await ann.inputValue("#edit-x"))).toBe(0);
    await Promise.all([ann.close(), ben.close()]);
  });

  it("add a copy of an object, which everyone sees and can move, and take it back", async () => {
    const { name, ann, ben } = await two(await withBlocks());
    await ben.uncheck("#automatic");
    const above = () => pixelAt(ben, BLOCK[0], BLOCK[1] - 0.3);
    const before = [...(await above())];
    const isAsBefore = async () => Math.max(...(await above()).map((value, n) => Math.abs(value - before[n]))) < 12;
    const parts = (page: Page) => page.locator("#edit-part option").evaluateAll((all) => all.map((one) => (one as HTMLOptionElement).value));
    await choose(ann, BLOCK, "object:blocks");
    await ann.click("#edit-copy");
    await expect.poll(() => ann.inputValue("#edit-part")).toBe("object:blocks copy");
    await expect.poll(() => ben.textContent("#edit-news")).toContain("blocks copy, added");
    await expect.poll(() => parts(ben)).toContain("object:blocks copy");
    await ann.fill("#edit-x", "0");
    await ann.fill("#edit-y", "250"); // of 550: the copies of the blocks float above them
    await expect.poll(isAsBefore).toBe(false);
    await waitForState(ben, "Done");
    await choose(ben, [BLOCK[0], BLOCK[1] - 0.3], "object:blocks copy");
    const late = await openPage(browser, `${server.url}#${name}`);
    await waitForEnd(late, name);
    await expect.poll(() => parts(late)).toContain("object:blocks copy");
    const steps = (await server.api.solves.getSolve({ name })).edits.length;
    for (let step = 0; step < steps; ++step) {
      await expect.poll(() => ben.isEnabled("#undo")).toBe(true);
      await ben.click("#undo");
      await expect.poll(async () => (await server.api.solves.getSolve({ name })).edits.length).toBe(steps + step + 1);
    }
    await expect.poll(isAsBefore).toBe(true);
    for (const page of [ann, ben, late]) await expect.poll(() => parts(page)).not.toContain("object:blocks copy");
    await Promise.all([ann.close(), ben.close(), late.close()]);
  });

  it("add what is in a file as an object on the floor, which everyone sees", async () => {
    const { name, ann, ben } = await two();
    const cube = [0, 1].flatMap((z) => [[0, 0, z], [1, 0, z], [1, 1, z], [0, 1, z]]);
    const sides = ["4 3 2 1", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"];
    const lines = [...cube.map((corner) => `v ${corner.map((x) => 100 * x).join(" ")}`), ...sides.map((side) => `f ${side}`)];
    const file = { name: "cube.obj", mimeType: "model/obj", buffer: Buffer.from(lines.join("\n")) };
    for (const wanted of ["cube", "cube 2"]) {
      await ann.setInputFiles("#edit-add", file);
      await expect.poll(() => ann.inputValue("#edit-part")).toBe(`object:${wanted}`);
      await expect.poll(() => ben.textContent("#edit-news")).toContain(`${wanted}, added`);
    }
    await waitForState(ben, "Done");
    const [{ value }] = (await server.api.solves.getSolve({ name })).edits[0].edits.flatMap(({ part }) => (part.case === "object" ? [part] : []));
    expect(Math.abs(value.move!.x - (278 - 50))).toBeLessThan(2); // the middle of the box is at 278
    expect(value.move!.y).toBe(0);
    await ann.setInputFiles("#edit-add", { ...file, name: "broken.obj", buffer: Buffer.from("f 1 2 3") });
    await expect.poll(() => ann.getAttribute("#state", "data-kind")).toBe("bad");
    await Promise.all([ann.close(), ben.close()]);
  });

  it("leave a part where it was, where the server refuses its place", async () => {
    const { ann, ben } = await two(await withBlocks());
    await choose(ann, BLOCK, "object:blocks");
    await ann.fill("#edit-x", "1e6");
    await expect.poll(() => ann.textContent("#state")).toContain("edits[0]");
    await expect.poll(() => ann.inputValue("#edit-x")).toBe("0");
    await ann.fill("#edit-x", "20");
    await waitForState(ann, "Done"); // and the refusal is no longer shown
    await Promise.all([ann.close(), ben.close()]);
  });

  it("let a day pass by a slider, which is one step, and darken the sky", async () => {
    const { name, ann, ben } = await two();
    await ben.uncheck("#automatic");
    const brightness = async () => (await pixelAt(ben, ...BACK_WALL))[1];
    const before = await brightness();
    await ann.selectOption("#edit-part", "daylight:");
    await ann.fill("#edit-latitude", "48.1");
    await ann.fill("#edit-longitude", "11.6");
    await ann.fill("#edit-utc", "0");
    await ann.fill("#edit-date", "2026-06-21");
    for (const minutes of ["360", "540", "720"]) await slide(ann, "#edit-time", minutes);
    await expect.poll(() => ann.textContent("#edit-clock")).toBe("12:00");
    await expect.poll(() => ben.textContent("#edit-news")).toBe("Ann edited sun and sky");
    const edits = async () => (await server.api.solves.getSolve({ name })).edits;
    const noon = { case: "daylight", value: { cieNumber: 12, sunTime: { latitudeDegrees: 48.1, time: { seconds: BigInt(Date.UTC(2026, 5, 21, 12) / 1000) } } } };
    await expect.poll(async () => (await edits()).at(-1)!.edits[0].part).toMatchObject(noon);
    expect(await edits()).toHaveLength(1);
    await expect.poll(brightness).toBeGreaterThan(before);
    await expect.poll(() => ben.isVisible("#edit-daylight")).toBe(false);
    await ben.selectOption("#edit-part", "daylight:");
    await expect.poll(() => ben.inputValue("#edit-latitude")).toBe("48.1");
    await ben.selectOption("#edit-sky", "dark");
    await expect.poll(() => ann.isVisible("#edit-sun")).toBe(false);
    await expect.poll(async () => Math.abs((await brightness()) - before)).toBeLessThan(6);
    await Promise.all([ann.close(), ben.close()]);
  });

  it("come to who joins later, and to who comes back", async () => {
    const { name, ann, ben } = await two();
    await ann.selectOption("#edit-part", "material:red");
    await slide(ann, "#edit-colour", "#3050e0");
    await waitForState(ben, "Done");
    const late = await openPage(browser, `${server.url}#${name}`);
    await waitForEnd(late, name);
    await expect.poll(() => redness(late)).toBeLessThan(-50);
    await server.kill();
    await server.start();
    for (const page of [ann, ben, late]) await expect.poll(() => redness(page)).toBeLessThan(-50);
    await late.selectOption("#edit-part", "material:red");
    expect(await late.inputValue("#edit-colour")).toBe("#3050e0");
    await slide(late, "#edit-colour", "#e03020");
    for (const page of [ann, ben, late]) await expect.poll(() => redness(page), { timeout: 20_000 }).toBeGreaterThan(50);
    await Promise.all([ann.close(), ben.close(), late.close()]);
  });
});
