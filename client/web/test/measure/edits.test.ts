// Pictures for docs/edits.md, and how soon another page shows an edit; scripts/edits.sh runs it.

import { appendFileSync, mkdirSync } from "node:fs";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, expect, it } from "vitest";
import type { Solve } from "../../src/gen/alvor/v1/solve_service_pb";
import { Server } from "../browser/server";
import { openBrowser, openPage, waitForState, type Page } from "../browser/viewer";

const ROOT = new URL("../../../../", import.meta.url);
const FURNISHED = ["furnished_room.obj", "furnished_room.mtl"].map((name) => new URL(`scenes/${name}`, ROOT).pathname);
const PICTURES = new URL("docs/edits/", ROOT);
const SETTLING_MS = 1000;

// The square lamp in the picture, in parts of it from the upper left corner, and how far to the left it is taken.
const LAMP = [0.7, 0.273] as const;
const STOPS = [0, 0.09, 0.18, 0.27, 0.36, 0.45];

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
});

async function solved(): Promise<Page> {
  const page = await openPage(browser, server.url, { width: 1100, height: 800 });
  await page.fill("#tolerance", "4");
  await page.setInputFiles("#files", FURNISHED);
  await waitForState(page, "Done");
  await page.uncheck("#automatic");
  return page;
}

const solveOf = (page: Page): Promise<Solve> => server.api.solves.getSolve({ name: new URL(page.url()).hash.slice(1).split("?")[0] });

/** Until what was done last is on the screen. */
async function settled(page: Page): Promise<void> {
  const isHeeded = async () => {
    const { edits, lastStep } = await solveOf(page);
    return edits.length > 0 && (lastStep?.edits ?? 0n) >= edits.at(-1)!.revision && !lastStep!.isProvisional;
  };
  await expect.poll(isHeeded, { timeout: 60_000 }).toBe(true);
  await page.waitForTimeout(SETTLING_MS);
}

const picture = (page: Page, name: string) => page.locator("#room").screenshot({ path: new URL(`${name}.png`, PICTURES).pathname });

it("shows edits of the furnished room", async () => {
  const page = await solved();
  await picture(page, "1_as_submitted");
  const edits: [string, string, string, string][] = [
    ["2_blue_walls", "material:wall", "#edit-colour", "#4060a0"],
    ["3_one_lamp_at_a_quarter", "object:lamp.001", "#edit-dim", "0.25"],
    ["4_and_off", "object:lamp.001", "#edit-dim", "0"],
    ["5_chair_turned", "object:chair.003", "#edit-turn", "60"],
    ["6_table_hidden", "object:table", "#edit-hidden", "on"],
  ];
  for (const [name, part, control, value] of edits) {
    const { edits: before } = await solveOf(page);
    await page.selectOption("#edit-part", part);
    await page.locator(control).evaluate((of, to) => {
      const control = of as HTMLInputElement;
      if (control.type === "checkbox") return control.click();
      control.value = to;
      of.dispatchEvent(new Event("input", { bubbles: true }));
    }, value);
    const isMade = async () => (await solveOf(page)).edits.at(-1)?.revision !== before.at(-1)?.revision;
    await expect.poll(isMade).toBe(true);
    await settled(page);
    await waitForState(page, "Done");
    await page.focus("#room");
    await page.keyboard.press("Escape"); // the picture is of the room, without the box around the part
    await page.waitForTimeout(SETTLING_MS);
    await picture(page, name);
  }
  await page.close();
});

/** Makes the page note when the first frame of the next edit comes, when it names who made it, and when it has drawn the frame. */
const awaitNews = (page: Page) =>
  page.evaluate(() => {
    const news = new Promise((resolve) => {
      const { alvor } = window as unknown as { alvor: { frames: number; latency: number } };
      const before = alvor.frames;
      let named = 0;
      new MutationObserver((_, observer) => {
        named = Date.now();
        observer.disconnect();
      }).observe(document.getElementById("edit-news")!, { childList: true });
      let first: { arrived: number; drawn: number } | undefined;
      const look = () => {
        if (!first && alvor.frames > before) first = { arrived: Date.now() - alvor.latency, drawn: Date.now() };
        if (first && named) resolve({ ...first, named });
        else requestAnimationFrame(look);
      };
      look();
    });
    Object.assign(window, { news });
  });
/** Returns the times that the page has noted, ms of Date.now(). */
const timesOfNews = (page: Page) =>
  page.evaluate(() => (window as unknown as { news: Promise<{ arrived: number; named: number; drawn: number }> }).news);

it("tells how soon another page shows an edit", async () => {
  const page = await solved();
  const { name } = await solveOf(page);
  const other = await openPage(browser, `${server.url}#${name}`, { width: 1100, height: 800 });
  await waitForState(other, "Done");
  await page.selectOption("#edit-part", "material:wall");
  const times: Record<"arrived" | "named" | "drawn", number[]> = { arrived: [], named: [], drawn: [] };
  for (let n = 0; n < 10; ++n) {
    await page.fill("#edit-author", `Ann ${n}`);
    await awaitNews(other);
    const begin = await page.locator("#edit-colour").evaluate((control, to) => {
      (control as HTMLInputElement).value = to;
      control.dispatchEvent(new Event("input", { bubbles: true }));
      return Date.now();
    }, n % 2 ? "#c0b0a0" : "#a0b0c0");
    for (const [event, at] of Object.entries(await timesOfNews(other))) times[event as keyof typeof times].push(at - begin);
    await settled(page);
    await waitForState(other, "Done");
  }
  for (const all of Object.values(times)) all.sort((a, b) => a - b);
  const median = (all: number[]) => Math.round(all[all.length / 2]);
  const summary = (all: number[]) => `${median(all)} ms (median; most ${Math.round(all.at(-1)!)} ms)`;
  const line =
    `The walls are recoloured on one page of a browser, the room at 4 %: another page has the first frame with the edit after ${summary(times.arrived)}, names who made it after ` +
    `${summary(times.named)} and has drawn it after ${summary(times.drawn)}. Aim: half a second: ${median(times.drawn) <= 500 ? "met" : "**missed**"} by the median, without a graphics card.`;
  if (process.env.ALVOR_FIGURES) appendFileSync(process.env.ALVOR_FIGURES, `\n${line}\n`);
  console.log(line);
  expect(times.drawn).toHaveLength(10);
  await Promise.all([page.close(), other.close()]);
});

it("films a lamp that is dragged across the furnished room", async () => {
  const page = await solved();
  const canvas = (await page.locator("#room").boundingBox())!;
  const pointTo = (left: number) => page.mouse.move(canvas.x + (LAMP[0] - left) * canvas.width, canvas.y + LAMP[1] * canvas.height);
  await page.selectOption("#edit-part", "object:lamp.002");
  await pointTo(0);
  await page.mouse.down();
  await page.waitForTimeout(SETTLING_MS);
  for (const [stop, left] of STOPS.entries()) {
    if (stop > 0) {
      await pointTo(left);
      await page.waitForTimeout(SETTLING_MS);
      await settled(page);
    }
    await picture(page, `drag_${stop + 1}`);
  }
  await page.mouse.up();
  await waitForState(page, "Done");
  expect((await solveOf(page)).edits).toHaveLength(1);
  await page.close();
});
