// A tab of a real browser, and what can be seen in it.

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { chromium, type Browser, type Page } from "playwright-core";

export type { Page } from "playwright-core";

// The picture is drawn by SwiftShader: machines that test have no graphics card.
const ARGUMENTS = [
  "--no-sandbox",
  "--disable-dev-shm-usage",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--enable-precise-memory-info",
  "--disable-quic",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  "--no-first-run",
];

export function openBrowser(): Promise<Browser> {
  return chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ARGUMENTS });
}

/** Fails the test on what the page logs as an error, lost connections excepted. */
export async function openPage(browser: Browser, url: string, size = { width: 1280, height: 720 }): Promise<Page> {
  const page = await browser.newPage({ viewport: size });
  page.setDefaultTimeout(60_000);
  page.on("pageerror", (error) => {
    throw error;
  });
  await page.goto(url);
  return page;
}

export const stateOf = (page: Page) => page.locator("#state").textContent();

export async function waitForState(page: Page, words: string): Promise<void> {
  await page.locator("#state", { hasText: words }).waitFor();
}

/** Of what the page says of itself: src/page/main.ts. */
export interface Measured {
  solve: string;
  hasEnded: boolean;
  /** A frame is here that is not on the screen yet, or the worker still holds the last one. */
  isWaiting: boolean;
  /** From the opening of a file to the first picture. */
  firstLit: number;
  /** From a frame's arrival to the picture: of each. */
  latencies: number[];
  applying: number;
  preparing: number;
  frames: number;
  slots: number;
  longestTask: number;
}

export const measuredBy = (page: Page) => page.evaluate(() => (window as unknown as { alvor: Measured }).alvor);

export async function waitForFrames(page: Page, count: number): Promise<void> {
  await page.waitForFunction((n) => (window as unknown as { alvor: Measured }).alvor.frames >= n, count);
}

/** Until all of this solve is on the screen. */
export async function waitForEnd(page: Page, solve: string): Promise<void> {
  await page.waitForFunction((name) => {
    const { alvor } = window as unknown as { alvor: Measured };
    return alvor.solve === name && alvor.hasEnded && alvor.frames > 0 && !alvor.isWaiting;
  }, solve);
}

/** What keeps people from using the page as it is now, by axe's rules: what it calls serious or critical. */
export async function obstacles(page: Page): Promise<string[]> {
  await page.evaluate(readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8"));
  const { violations } = await page.evaluate(() =>
    (window as unknown as { axe: { run(): Promise<{ violations: { id: string; impact: string; nodes: { html: string }[] }[] }> } }).axe.run(),
  );
  const serious = violations.filter(({ impact }) => impact === "serious" || impact === "critical");
  return serious.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join("; ")}`);
}

/** Runs in the page: when it says what after the click, ms. */
export function watchPause(): void {
  const pause = { said: 0, paused: 0 };
  Object.assign(window, { pause });
  let clicked = 0;
  document.getElementById("pause")!.addEventListener("click", () => (clicked = performance.now()), { capture: true });
  new MutationObserver(() => {
    const text = document.getElementById("state")!.textContent;
    if (text === "Pausing…") pause.said = performance.now() - clicked;
    if (text === "Paused") pause.paused = performance.now() - clicked;
  }).observe(document.getElementById("state")!, { childList: true });
}

export const pauseSeenBy = (page: Page) => page.evaluate(() => (window as unknown as { pause: { said: number; paused: number } }).pause);

export type Pixel = [number, number, number];

/** The mean colour around a point of the canvas: 0 to 1 from its upper left corner. */
export function pixelAt(page: Page, x: number, y: number, radius = 3): Promise<Pixel> {
  return page.evaluate(
    ([u, v, r]) => {
      const canvas = document.getElementById("room") as HTMLCanvasElement;
      const copy = document.createElement("canvas");
      copy.width = copy.height = 2 * r + 1;
      const pen = copy.getContext("2d")!;
      pen.drawImage(canvas, r - u * canvas.width, r - v * canvas.height);
      const { data } = pen.getImageData(0, 0, copy.width, copy.height);
      const sum = [0, 0, 0];
      for (let n = 0; n < data.length; ++n) if (n % 4 < 3) sum[n % 4] += data[n];
      return sum.map((s) => s / (data.length / 4)) as [number, number, number];
    },
    [x, y, radius],
  );
}

/** Of the whole picture, 0 to 255. */
export function meanBrightness(page: Page): Promise<number> {
  return page.evaluate(() => {
    const canvas = document.getElementById("room") as HTMLCanvasElement;
    const copy = document.createElement("canvas");
    copy.width = copy.height = 100;
    const pen = copy.getContext("2d")!;
    pen.drawImage(canvas, 0, 0, 100, 100);
    const { data } = pen.getImageData(0, 0, 100, 100);
    let sum = 0;
    for (let n = 0; n < data.length; ++n) if (n % 4 < 3) sum += data[n];
    return sum / (3 * 100 * 100);
  });
}
