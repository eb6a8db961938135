// Pictures for docs/edits.md; scripts/edits.sh runs it.

import { mkdirSync } from "node:fs";
import { it } from "vitest";
import { Server } from "../browser/server";
import { openBrowser, openPage, waitForState } from "../browser/viewer";

const ROOT = new URL("../../../../", import.meta.url);
const FURNISHED = ["furnished_room.obj", "furnished_room.mtl"].map((name) => new URL(`scenes/${name}`, ROOT).pathname);
const PICTURES = new URL("docs/edits/", ROOT);

it("films edits of the furnished room", async () => {
  mkdirSync(PICTURES, { recursive: true });
  const server = new Server();
  await server.start();
  const browser = await openBrowser();
  const page = await openPage(browser, server.url, { width: 1100, height: 800 });
  await page.fill("#tolerance", "4");
  await page.setInputFiles("#files", FURNISHED);
  await waitForState(page, "Done");
  await page.uncheck("#automatic");
  const picture = (name: string) => page.locator("#room").screenshot({ path: new URL(`${name}.png`, PICTURES).pathname });
  await picture("1_as_submitted");
  const edits: [string, string, string, string][] = [
    ["2_blue_walls", "material:wall", "#edit-colour", "#4060a0"],
    ["3_one_lamp_at_a_quarter", "object:lamp.001", "#edit-dim", "0.25"],
    ["4_and_off", "object:lamp.001", "#edit-dim", "0"],
    ["5_chair_turned", "object:chair.003", "#edit-turn", "60"],
    ["6_table_hidden", "object:table", "#edit-hidden", "on"],
  ];
  for (const [count, [name, part, control, value]] of edits.entries()) {
    await page.selectOption("#edit-part", part);
    await page.locator(control).evaluate((of, to) => {
      const control = of as HTMLInputElement;
      if (control.type === "checkbox") return control.click();
      control.value = to;
      of.dispatchEvent(new Event("input", { bubbles: true }));
    }, value);
    const edited = async () => {
      const stored = (await server.api.scenes.listScenes({})).scenes[0];
      const { solves } = await server.api.solves.listSolves({ parent: stored.name });
      return (solves[0].lastStep?.edits ?? 0n) >= BigInt(count + 1);
    };
    while (!(await edited())) await page.waitForTimeout(50);
    await waitForState(page, "Done");
    await page.waitForTimeout(1000);
    await picture(name);
  }
  await browser.close();
  await server.stop();
});
