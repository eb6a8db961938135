// Figures and pictures for docs/page.md; scripts/page.sh runs it.

import { mkdirSync, readdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { createScene, Server, type Quad } from "../browser/server";
import { measuredBy, openBrowser, openPage, pauseSeenBy, waitForFrames, waitForState, watchPause, type Measured, type Page } from "../browser/viewer";

const ROOT = new URL("../../../../", import.meta.url);
const CORNELL = ["cornell_box.obj", "cornell_box.mtl"].map((name) => new URL(`scenes/${name}`, ROOT).pathname);
const FURNISHED = ["furnished_room.obj", "furnished_room.mtl"].map((name) => new URL(`scenes/${name}`, ROOT).pathname);
const PICTURES = new URL("docs/page/", ROOT);

const rows: string[] = [];
const note = (what: string, aim: string, seen: string) => rows.push(`| ${what} | ${aim} | ${seen} |`);
const ms = (x: number) => `${Math.round(x)} ms`;
const quantile = (all: number[], q: number) => [...all].sort((a, b) => a - b)[Math.min(all.length - 1, Math.floor(q * all.length))];

let server: Server;
let browser: Browser;
beforeAll(async () => {
  mkdirSync(PICTURES, { recursive: true });
  server = new Server();
  await server.start();
  browser = await openBrowser();
});
afterAll(async () => {
  await browser?.close();
  await server?.stop();
  const text = readFileSync(new URL("docs/page.md", ROOT), "utf8");
  const table = ["| what | aim | seen |", "|---|---|---|", ...rows].join("\n");
  writeFileSync(new URL("docs/page.md", ROOT), text.replace(/\| what \| aim[^]*?(?=\n\n|\n$)/, table));
});

const picture = (page: Page, name: string) => page.screenshot({ path: new URL(`${name}.png`, PICTURES).pathname });

/** Tiles of a floor that grow brighter together: each revision changes all of them. */
function tiles(side: number): Quad[] {
  const floor = Array.from({ length: side * side }, (_, n): Quad => {
    const [x, z] = [n % side, Math.floor(n / side)];
    return { corners: [[x, 0, z], [x, 0, z + 1], [x + 1, 0, z + 1], [x + 1, 0, z]], reflectance: [0.9, 0.9, 0.9] };
  });
  const at = (x: number, z: number): [number, number, number] => [x * side, 0.4 * side, z * side];
  const lamp: Quad = { corners: [at(0.3, 0.3), at(0.7, 0.3), at(0.7, 0.7), at(0.3, 0.7)], emission: [900, 900, 900], reflectance: [0.9, 0.9, 0.9] };
  return [...floor, lamp];
}

/** Resident bytes of the server's process. */
const residentBytes = () => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${server.pid}/status`, "utf8"))![1]) * 1024;
const heapBytes = async (page: Page) => {
  const session = await page.context().newCDPSession(page);
  await session.send("HeapProfiler.collectGarbage");
  return ((await session.send("Runtime.getHeapUsage")) as { usedSize: number }).usedSize;
};

describe("the page's figures", () => {
  it("weighs", () => {
    const folder = new URL("build/release/bin/web/", ROOT);
    const assets = readdirSync(new URL("assets/", folder)).map((name) => `assets/${name}`);
    const sizes = ["index.html.gz", "icon.svg.gz", ...assets.filter((name) => name.endsWith(".gz"))].map(
      (name) => statSync(new URL(name, folder)).size,
    );
    note("page weight, gzip", "<= 400 KB", `${Math.round(sizes.reduce((a, b) => a + b) / 1000)} KB`);
  });

  it("shows the Cornell box", async () => {
    const lit: number[] = [];
    for (let n = 0; n < 3; ++n) {
      const page = await openPage(browser, server.url);
      await page.setInputFiles("#files", CORNELL);
      await waitForState(page, "Done");
      lit.push((await measuredBy(page)).firstLit);
      await page.close();
    }
    note("first lit picture after the Cornell box is dropped, of three", "1 s", ms(quantile(lit, 0.5)));
  });

  it("pauses", async () => {
    const page = await openPage(browser, server.url);
    await page.fill("#tolerance", "2");
    await page.setInputFiles("#files", FURNISHED);
    await waitForFrames(page, 1);
    const moments: { said: number; paused: number }[] = [];
    for (let n = 0; n < 5; ++n) {
      await page.waitForTimeout(400);
      await page.evaluate(watchPause);
      await page.click("#pause");
      await page.locator("#state", { hasText: /Paused|Done/ }).waitFor();
      if ((await page.locator("#state").textContent())!.startsWith("Done")) break;
      moments.push(await pauseSeenBy(page));
      await page.click("#pause");
      await page.locator("#state", { hasText: /Solving|Done/ }).waitFor();
    }
    const worst = (what: "said" | "paused") => ms(Math.max(...moments.map((moment) => moment[what])));
    const paused = moments.map((moment) => moment.paused);
    note(`from a click on Pause to the word "Pausing…", longest of ${moments.length}`, "100 ms", worst("said"));
    note("from a click on Pause until the furnished room's solve at 2 % stands still, median and longest of them", "1 s", `${ms(quantile(paused, 0.5))}, ${worst("paused")}`);
    await page.close();
  });

  it("shows four moments of a solve", async () => {
    const stored = (await server.api.scenes.listScenes({})).scenes[0];
    const stepPause = { seconds: 0n, nanos: 700_000_000 };
    const solve = await server.api.solves.createSolve({ parent: stored.name, solve: { spec: { tolerance: 0.01, stepPause } } });
    const page = await openPage(browser, `${server.url}#${solve.name}`);
    await waitForFrames(page, 1);
    await page.waitForTimeout(300);
    await picture(page, "1_direct_light");
    await page.check("#mesh");
    await page.waitForTimeout(6000);
    await picture(page, "2_mesh");
    await page.uncheck("#mesh");
    await page.selectOption("#show", "irradiance");
    const box = (await page.locator("#room").boundingBox())!;
    await page.locator("#room").click({ position: { x: 0.53 * box.width, y: 0.35 * box.height } });
    await page.waitForTimeout(5000);
    await picture(page, "3_irradiance");
    await page.selectOption("#show", "room");
    await page.emulateMedia({ colorScheme: "dark" });
    await page.reload();
    await waitForState(page, "Done");
    await page.waitForTimeout(500);
    await picture(page, "4_done");
    await page.close();
  });

  it("keeps up with 100 000 leaves", async () => {
    const stored = await createScene(server.api, tiles(317));
    const stepPause = { seconds: 0n, nanos: 900_000_000 };
    const spec = { maxDepth: 0, tolerance: 0.0005, strategy: 1, stepPause, timeLimit: { seconds: 10n } };
    const solve = await server.api.solves.createSolve({ parent: stored.name, solve: { spec } });
    const page = await openPage(browser, `${server.url}#${solve.name}`);
    await page.locator("#state", { hasText: /Done|Cancelled/ }).waitFor({ timeout: 100_000 });
    const { latencies, applying, preparing, longestTask, slots } = await measuredBy(page);
    expect(slots).toBeGreaterThan(100_000);
    note("a frame of 100 490 leaves from its arrival to the screen, median, drawn without a graphics card", "100 ms", `${ms(quantile(latencies, 0.5))} (90 % within ${ms(quantile(latencies, 0.9))}, of ${latencies.length})`);
    note("of that: decoding and applying, making ready (in the worker), last frame", "", `${ms(applying)}, ${ms(preparing)}`);
    note("longest task of the page's thread meanwhile", "50 ms", ms(longestTask));
    await page.close();
  });

  it("does not grow", async () => {
    const stored = (await server.api.scenes.listScenes({})).scenes.at(-1)!;
    const stepPause = { seconds: 0n, nanos: 20_000_000 };
    const page = await openPage(browser, server.url);
    let frames = 0;
    let early = 0;
    for (let n = 0; frames < 2000; ++n) {
      const spec = { tolerance: 0.02, strategy: 1, stepPause, seed: BigInt(n) };
      const solve = await server.api.solves.createSolve({ parent: stored.name, solve: { spec } });
      await page.evaluate((name) => (location.hash = name), solve.name);
      await page.waitForFunction(
        (name) => {
          const { alvor } = window as unknown as { alvor: Measured };
          return alvor.solve === name && alvor.hasEnded;
        },
        solve.name,
        { timeout: 60_000 },
      );
      frames += (await measuredBy(page)).frames;
      if (early === 0 && frames >= 200) early = await heapBytes(page);
    }
    const late = await heapBytes(page);
    note("page's heap after 200 and after 2000 frames", "steady", `${(early / 1e6).toFixed(1)} MB, ${(late / 1e6).toFixed(1)} MB`);
    await page.close();
  }, 600_000);

  it("costs the server little for a second tab", async () => {
    const stored = (await server.api.scenes.listScenes({})).scenes.at(-1)!;
    const stepPause = { seconds: 20n }; // nothing happens for so long
    const solve = await server.api.solves.createSolve({ parent: stored.name, solve: { spec: { tolerance: 0.01, stepPause } } });
    const first = await openPage(browser, `${server.url}#${solve.name}`);
    await waitForFrames(first, 1);
    await first.waitForTimeout(1000);
    const before = residentBytes();
    const tabs = [first];
    const cost = async (count: number) => {
      for (let n = 0; n < count; ++n) {
        tabs.push(await openPage(browser, `${server.url}#${solve.name}`));
        await waitForFrames(tabs.at(-1)!, 1);
      }
      await first.waitForTimeout(1000);
      return residentBytes();
    };
    const withTwo = await cost(1);
    const withFive = await cost(3);
    const megabytes = (count: number) => `${(count / 1e6).toFixed(2)} MB`;
    note("server's memory for a second tab, and for each of three more", "< 1 MB", `${megabytes(withTwo - before)}, ${megabytes((withFive - withTwo) / 3)}`);
    await Promise.all(tabs.map((tab) => tab.close()));
  });
});
