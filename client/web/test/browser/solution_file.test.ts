// A compact solution file that alvor solve wrote, opened by the page.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, it } from "vitest";
import { Server } from "./server";
import { openBrowser, openPage, pixelAt, stateOf, waitForEnd, waitForState, type Page } from "./viewer";

const ROOT = new URL("../../../../", import.meta.url).pathname;
const ALVOR = join(ROOT, "build/release/bin/alvor");
const PLACES = [0.2, 0.35, 0.5, 0.65, 0.8].flatMap((x) => [0.25, 0.5, 0.75].map((y) => [x, y] as const));

let server: Server;
let browser: Browser;
const folder = mkdtempSync(join(tmpdir(), "alvor-file-"));
beforeAll(async () => {
  server = new Server();
  await server.start();
  browser = await openBrowser();
});
afterAll(async () => {
  await browser?.close();
  await server?.stop();
  rmSync(folder, { recursive: true });
});

const pixelsOf = async (page: Page) => {
  const pixels = [];
  for (const [x, y] of PLACES) pixels.push(await pixelAt(page, x, y));
  return pixels;
};

it.each(["scenes/cornell_box.obj", "tests/import/blender/files/room.glb"])("shows %s as its solve does", async (scene) => {
  const file = join(folder, "room.alvor");
  execFileSync(ALVOR, ["solve", scene, "-o", file, "--tolerance", "0.1", "--server", server.listening, "-q"], { cwd: ROOT, stdio: "ignore" });
  const stored = (await server.api.scenes.listScenes({})).scenes[0];
  const { name } = (await server.api.solves.listSolves({ parent: stored.name })).solves[0];
  const solved = await openPage(browser, `${server.url}#${name}`);
  await waitForEnd(solved, name);
  const opened = await openPage(browser, server.url);
  await opened.setInputFiles("#files", file);
  await waitForState(opened, "Shown from a file");
  await expect
    .poll(async () => {
      const [a, b] = [await pixelsOf(solved), await pixelsOf(opened)];
      return Math.max(...a.map((pixel, n) => Math.max(...pixel.map((band, k) => Math.abs(band - b[n][k])))));
    }, { timeout: 20_000 })
    .toBeLessThan(4);
  const box = (await opened.locator("#room").boundingBox())!;
  await opened.locator("#room").click({ position: { x: box.width / 2, y: box.height / 2 } });
  await opened.locator("#reading").waitFor();
  expect(await opened.locator("#reading").textContent()).toMatch(/^I(rradi|llumin)ance [\d.]+, [\d.]+, [\d.]+ ± [\d.]+/);
  await Promise.all([solved.close(), opened.close()]);
});

it("says what is wrong with a file, and goes on", async () => {
  const file = join(folder, "room.alvor");
  execFileSync(ALVOR, ["solve", "scenes/cornell_box.obj", "-o", file, "--tolerance", "0.1", "-q"], { cwd: ROOT, stdio: "ignore" });
  const whole = readFileSync(file);
  writeFileSync(join(folder, "cut.alvor"), whole.subarray(0, whole.length / 2));
  writeFileSync(join(folder, "prose.alvor"), "It was a dark and stormy night");
  const page = await openPage(browser, server.url);
  await page.setInputFiles("#files", join(folder, "cut.alvor"));
  await waitForState(page, "the file is cut off");
  await page.setInputFiles("#files", join(folder, "prose.alvor"));
  await waitForState(page, "no solution file");
  await page.setInputFiles("#files", file);
  await waitForState(page, "Shown from a file");
  expect(await stateOf(page)).toBe("Shown from a file");
  await page.close();
});
