// Pictures for docs/edits.md; scripts/edits.sh runs it.

import { mkdirSync } from "node:fs";
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
