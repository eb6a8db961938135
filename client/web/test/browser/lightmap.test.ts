// A scene that alvor bake wrote, as three.js shows it with the plugin of examples/lightmap, beside what alvor render draws.
import { execFileSync } from "node:child_process";
import { createServer, type Server } from "node:http";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import type { AddressInfo } from "node:net";
import { tmpdir } from "node:os";
import { extname, join } from "node:path";
import type { Browser } from "playwright-core";
import { afterAll, beforeAll, describe, expect, it } from "vitest";
import { openBrowser, openPage } from "./viewer";

const ROOT = new URL("../../../../", import.meta.url).pathname;
const ALVOR = join(ROOT, "build/release/bin/alvor");
const WIDE = 640;
const HIGH = 480;
const TYPES: Record<string, string> = { ".html": "text/html", ".js": "text/javascript", ".png": "image/png" };

const PAGE = `<!doctype html><script type="importmap">{ "imports": {
  "three": "/three/build/three.module.js", "three/addons/": "/three/examples/jsm/" } }</script>
<script type="module">
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { lightmaps } from "/lightmap/lightmap.js";
window.show = async (file, { eye, target, fov, wide, high }) => {
  const renderer = new THREE.WebGLRenderer();
  const scene = new THREE.Scene().add((await new GLTFLoader().register(lightmaps).loadAsync(file)).scene);
  const camera = new THREE.PerspectiveCamera(fov, wide / high, 0.1, 5000);
  camera.position.set(...eye);
  camera.lookAt(...target);
  const image = new THREE.WebGLRenderTarget(wide, high, { type: THREE.FloatType, samples: 4 });
  renderer.setRenderTarget(image);
  renderer.render(scene, camera);
  const pixels = new Float32Array(4 * wide * high);
  renderer.readRenderTargetPixels(image, 0, 0, wide, high, pixels);
  return Array.from(pixels);
};
window.read = async (file) => {
  const image = await createImageBitmap(await (await fetch(file)).blob(), { colorSpaceConversion: "none" });
  const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
  context.drawImage(image, 0, 0);
  return Array.from(context.getImageData(0, 0, image.width, image.height).data);
};
window.isReady = true;
</script>`;

/** The filmic curve and the sRGB encoding of client/picture/tone_map.cpp. */
function shown(exposed: number): number {
  const x = Math.min(Math.max(exposed, 0), 1000);
  const linear = Math.min(1, (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14));
  return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055);
}

/** Returns the peak signal-to-noise ratio of the radiances (rows from the bottom), exposed, to a picture (rows from the top), dB. */
function psnr(radiances: number[], picture: number[], exposure: number): number {
  let squares = 0;
  let count = 0;
  for (let y = 0; y < HIGH; ++y)
    for (let x = 0; x < WIDE; ++x)
      for (let band = 0; band < 3; ++band) {
        const drawn = picture[4 * (y * WIDE + x) + band];
        const found = shown(exposure * radiances[4 * ((HIGH - 1 - y) * WIDE + x) + band]);
        if (drawn > 250) continue; // lamps
        squares += (drawn - found) ** 2;
        count += 1;
      }
  expect(count).toBeGreaterThan(2 * WIDE * HIGH);
  return 10 * Math.log10(255 ** 2 / (squares / count));
}

/** The picture was exposed automatically: returns the ratio at the exposure that fits best. */
function bestPsnr(radiances: number[], picture: number[]): number {
  let best = -Infinity;
  let middle = 0;
  for (let step = 2; step > 0.004; step /= 4) {
    const tries = [-4, -3, -2, -1, 0, 1, 2, 3, 4].map((n) => middle + n * step);
    for (const stops of tries) {
      const found = psnr(radiances, picture, 2 ** stops);
      if (found > best) [best, middle] = [found, stops];
    }
  }
  return best;
}

let folder: string;
let server: Server;
let browser: Browser;
let url: string;
beforeAll(async () => {
  folder = mkdtempSync(join(tmpdir(), "alvor-lightmap-"));
  const roots = { three: join(ROOT, "client/web/node_modules/three"), lightmap: join(ROOT, "examples/lightmap"), out: folder };
  server = createServer((request, response) => {
    const [, root, ...path] = new URL(request.url!, "http://localhost").pathname.split("/");
    try {
      const body = root === "" ? PAGE : readFileSync(join(roots[root as keyof typeof roots], ...path));
      response.writeHead(200, { "content-type": root === "" ? "text/html" : (TYPES[extname(path.at(-1)!)] ?? "application/octet-stream") });
      response.end(body);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise<void>((done) => server.listen(0, "127.0.0.1", done));
  url = `http://127.0.0.1:${(server.address() as AddressInfo).port}/`;
  browser = await openBrowser();
});
afterAll(async () => {
  await browser?.close();
  server?.close();
  rmSync(folder, { recursive: true, force: true });
});

function alvor(...words: string[]): void {
  execFileSync(ALVOR, [...words, "-q"], { cwd: folder });
}

describe("a baked scene in three.js", () => {
  it.each([
    ["cornell_box", [278, 273, 20], [278, 250, 280], 80],
    ["furnished_room", [0.4, 1.7, 0.4], [3, 0.9, 2.5], 70],
  ] as const)("looks as alvor render draws it: %s", async (name, eye, target, fov) => {
    const scene = join(ROOT, `scenes/${name}.obj`);
    alvor("solve", scene, "-o", "room.glb", "--tolerance", "0.05");
    alvor("bake", scene, "--solution", "room.glb", "-o", "baked.glb", "--size", "2048");
    alvor("render", "room.glb", "-o", "room.png", "--eye", eye.join(), "--target", target.join(), "--fov", String(fov), "--width", String(WIDE), "--height", String(HIGH));
    const page = await openPage(browser, url);
    await page.waitForFunction("window.isReady");
    const view = { eye, target, fov, wide: WIDE, high: HIGH };
    const radiances = (await page.evaluate(`window.show("/out/baked.glb", ${JSON.stringify(view)})`)) as number[];
    const picture = (await page.evaluate('window.read("/out/room.png")')) as number[];
    const found = bestPsnr(radiances, picture);
    console.log(`${name}: ${found.toFixed(1)} dB`);
    expect(found).toBeGreaterThan(35);
    await page.close();
  });
});
