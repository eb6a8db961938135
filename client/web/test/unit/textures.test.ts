import { create } from "@bufbuild/protobuf";
import { Code, ConnectError } from "@connectrpc/connect";
import { describe, expect, it } from "vitest";
import type { Api } from "../../src/api";
import { ReadImagesResponseSchema, Texture_Wrap, TextureSchema } from "../../src/gen/alvor/v1/scene_service_pb";
import { bytesOf, ImageCollector, LINEAR, opacityAt, reflectanceAt, wrapped, type Image } from "../../src/textures/image";
import { byteOfOpacity, encoding, levelsOf, texelsOf } from "../../src/textures/pyramid";
import { readImages } from "../../src/textures/reading";
import { piecesOf, sheetFor, TABLE_WORDS, tableOf, type Sheet } from "../../src/textures/sheet";

const { REPEAT, MIRROR, CLAMP } = Texture_Wrap;

/** Grey texels. */
const imageOf = (columns: number, greys: number[]): Image => ({
  columns,
  rows: greys.length / columns,
  hasOpacity: false,
  texels: Uint8Array.from(greys.flatMap((grey) => [grey, grey, grey])),
});

/** Grey texels, each with its opacity. */
const cutOutOf = (columns: number, texels: [grey: number, opacity: number][]): Image => ({
  columns,
  rows: texels.length / columns,
  hasOpacity: true,
  texels: Uint8Array.from(texels.flatMap(([grey, opacity]) => [grey, grey, grey, opacity])),
});

/** Bytes of all kinds, each time the same. */
function noise(columns: number, rows: number, hasOpacity = false): Image {
  let state = 1;
  const next = () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) >>> 24;
  return { columns, rows, hasOpacity, texels: Uint8Array.from({ length: bytesOf({ hasOpacity }) * columns * rows }, next) };
}

describe("beyond its edge an image", () => {
  it.each([
    [REPEAT, [1, 2, 0, 1, 2, 0, 1]],
    [MIRROR, [1, 0, 0, 1, 2, 2, 1]],
    [CLAMP, [0, 0, 0, 1, 2, 2, 2]],
    [Texture_Wrap.WRAP_UNSPECIFIED, [1, 2, 0, 1, 2, 0, 1]],
  ])("goes on as wrap %d says", (wrap, texels) => {
    expect([-2, -1, 0, 1, 2, 3, 4].map((n) => wrapped(n, 3, wrap))).toEqual(texels);
  });
});

describe("reflectance", () => {
  const image = imageOf(2, [0, 100, 200, 255]);
  const texture = (wrap: Texture_Wrap) => create(TextureSchema, { wrapS: wrap, wrapT: wrap });

  it("is that of a texel in its middle, and linear between them", () => {
    expect(reflectanceAt(image, texture(CLAMP), 0.75, 0.25)[0]).toBe(LINEAR[100]);
    expect(reflectanceAt(image, texture(CLAMP), 0.5, 0.25)[0]).toBeCloseTo(LINEAR[100] / 2, 12);
    expect(reflectanceAt(image, texture(CLAMP), 0.25, 0.5)[1]).toBeCloseTo(LINEAR[200] / 2, 12);
    expect(reflectanceAt(image, texture(CLAMP), 0.5, 0.5)[2]).toBeCloseTo((LINEAR[100] + LINEAR[200] + LINEAR[254]) / 4, 12);
  });

  it("meets the other side where the image repeats, and itself where it ends or turns", () => {
    expect(reflectanceAt(image, texture(REPEAT), 0, 0.25)[0]).toBeCloseTo(LINEAR[100] / 2, 12);
    expect(reflectanceAt(image, texture(REPEAT), -2, 3.25)[0]).toBeCloseTo(LINEAR[100] / 2, 12);
    expect(reflectanceAt(image, texture(MIRROR), 1, 0.25)[0]).toBeCloseTo(LINEAR[100], 12);
    expect(reflectanceAt(image, texture(MIRROR), 1.75, 0.25)[0]).toBe(0);
    expect(reflectanceAt(image, texture(CLAMP), 9, 0.25)[0]).toBe(LINEAR[100]);
  });

  it("has the texture's factor, and a byte of 255 counts as 254", () => {
    const tinted = create(TextureSchema, { factor: { r: 0.5, g: 1, b: 0 }, wrapS: CLAMP, wrapT: CLAMP });
    expect(reflectanceAt(image, tinted, 1, 1)).toEqual([0.5 * LINEAR[254], LINEAR[254], 0]);
    expect(LINEAR[255]).toBe(LINEAR[254]);
    expect(LINEAR[254]).toBeCloseTo(0.991102, 6); // as view/texture_shader.ts has it
  });
});

describe("opacity", () => {
  const texture = (wrap: Texture_Wrap) => create(TextureSchema, { wrapS: wrap, wrapT: wrap });
  const image = cutOutOf(2, [[100, 255], [200, 0], [50, 51], [0, 0]]);

  it("is that of the texel at the place, without a step between", () => {
    expect(opacityAt(image, texture(CLAMP), 0.49, 0.49)).toBe(1);
    expect(opacityAt(image, texture(CLAMP), 0.51, 0.49)).toBe(0);
    expect(opacityAt(image, texture(CLAMP), 0.1, 0.51)).toBe(0.2);
  });

  it("goes on beyond the edge as the image does", () => {
    expect(opacityAt(image, texture(CLAMP), -3, -3)).toBe(1);
    expect(opacityAt(image, texture(REPEAT), -0.1, 0.2)).toBe(0);
    expect(opacityAt(image, texture(MIRROR), -0.1, 0.2)).toBe(1);
  });

  it("is 1 where the image has none", () => {
    expect(opacityAt(imageOf(1, [0]), texture(CLAMP), 0.5, 0.5)).toBe(1);
  });

  it("weights the colours between texels: holes have none", () => {
    expect(reflectanceAt(image, texture(CLAMP), 0.4, 0.25)[0]).toBeCloseTo(LINEAR[100], 12);
    expect(reflectanceAt(image, texture(CLAMP), 0.25, 0.5)[1]).toBeCloseTo((LINEAR[100] + 0.2 * LINEAR[50]) / 1.2, 12);
    expect(reflectanceAt(image, texture(CLAMP), 1, 0.25)).toEqual([0, 0, 0]);
  });
});

describe("images that come in pieces", () => {
  it("are put together, wherever they are cut", () => {
    const images = [imageOf(2, [1, 2, 3, 4]), imageOf(1, [5, 6])];
    const all = Uint8Array.from(images.flatMap(({ texels }) => [...texels]));
    for (let cut = 0; cut <= all.length; ++cut) {
      const collector = new ImageCollector();
      collector.take(create(ReadImagesResponseSchema, { images: [{ columns: 2, rows: 2 }], texels: all.subarray(0, Math.min(cut, 12)) }));
      collector.take(create(ReadImagesResponseSchema, { images: [{ columns: 1, rows: 2 }], texels: all.subarray(Math.min(cut, 12), cut) }));
      expect(collector.isWhole).toBe(cut === all.length);
      collector.take(create(ReadImagesResponseSchema, { texels: all.subarray(cut) }));
      expect(collector.images).toEqual(images);
      expect(collector.isWhole).toBe(true);
    }
  });

  it("have no more texels than they said", () => {
    const message = create(ReadImagesResponseSchema, { images: [{ columns: 1, rows: 1 }], texels: new Uint8Array(4) });
    expect(() => new ImageCollector().take(message)).toThrow("more texels");
  });

  it("have four bytes a texel where they have opacities, whatever the others have", () => {
    const images = [imageOf(1, [1, 2]), cutOutOf(2, [[3, 4], [5, 6]]), imageOf(1, [7])];
    const all = Uint8Array.from(images.flatMap(({ texels }) => [...texels]));
    const sizes = images.map(({ columns, rows, hasOpacity }) => ({ columns, rows, hasOpacity }));
    for (let cut = 0; cut <= all.length; ++cut) {
      const collector = new ImageCollector();
      collector.take(create(ReadImagesResponseSchema, { images: sizes, texels: all.subarray(0, cut) }));
      expect(collector.isWhole).toBe(cut === all.length);
      collector.take(create(ReadImagesResponseSchema, { texels: all.subarray(cut) }));
      expect(collector.images).toEqual(images);
    }
    const tooLong = create(ReadImagesResponseSchema, { images: sizes, texels: new Uint8Array(all.length + 1) });
    expect(() => new ImageCollector().take(tooLong)).toThrow("more texels");
  });

  /** A server that answers the n-th call with the n-th of these. */
  function serverOf(...answers: (Error | Uint8Array)[]) {
    let calls = 0;
    async function* answer() {
      const next = answers[calls++];
      yield create(ReadImagesResponseSchema, { images: [{ columns: 1, rows: 2 }], texels: Uint8Array.of(1, 1, 1) });
      if (next instanceof Error) throw next;
      yield create(ReadImagesResponseSchema, { texels: next });
    }
    return { api: { scenes: { readImages: answer } } as unknown as Api, calls: () => calls };
  }
  const lost = new ConnectError("gone", Code.Unavailable);

  it("come from the beginning again when the connection was lost, or the stream ended early", async () => {
    const { api, calls } = serverOf(lost, new Uint8Array(0), Uint8Array.of(2, 2, 2));
    expect(await readImages(api, "scenes/a", [1, 1])).toEqual([imageOf(1, [1, 2])]);
    expect(calls()).toBe(3);
  });

  it("are given up in the end, and at once where the server refuses", async () => {
    const down = serverOf(lost, lost, lost);
    await expect(readImages(down.api, "scenes/a", [1, 1])).rejects.toThrow("gone");
    expect(down.calls()).toBe(3);
    const old = serverOf(new ConnectError("unknown call", Code.Unimplemented));
    await expect(readImages(old.api, "scenes/a", [1, 1])).rejects.toThrow("unknown call");
    expect(old.calls()).toBe(1);
  });
});

const ONE = 65535;
const meanOf = (bands: Uint8Array | Uint16Array, band: number) => {
  let sum = 0;
  for (let n = band; n < bands.length; n += 3) sum += bands instanceof Uint8Array ? LINEAR[bands[n]] : bands[n] / ONE;
  return sum / (bands.length / 3);
};

describe("the levels of an image", () => {
  it.each([[64, 64], [128, 8], [1, 16]])("of %d x %d all have its mean", (columns, rows) => {
    const image = noise(columns, rows);
    const bytes = encoding();
    for (const { bands } of levelsOf(image))
      for (let band = 0; band < 3; ++band) {
        const mean = meanOf(image.texels, band);
        // Each level rounds by half of 1 / 65535 at most, of seven.
        expect(Math.abs(meanOf(bands, band) - mean)).toBeLessThan(4 / ONE);
        if (bands instanceof Uint8Array) continue;
        // A byte rounds by half of a step of the curve, which is 2.28 / 255 where it is steepest.
        const encoded = Uint8Array.from(bands, (word) => bytes[word]);
        expect(Math.abs(meanOf(encoded, band) - mean)).toBeLessThan(1.14 / 255 + 4 / ONE);
      }
  });

  it("halve rounded up, and repeat the last column and row of odd sizes", () => {
    const [, second, third] = levelsOf(imageOf(3, [0, 0, 100, 0, 0, 100, 200, 200, 50]));
    expect([second.columns, second.rows, third.columns, third.rows]).toEqual([2, 2, 1, 1]);
    const grey = [0, 1, 2, 3].map((n) => second.bands[3 * n] / ONE);
    [0, LINEAR[100], LINEAR[200], LINEAR[50]].forEach((x, n) => expect(Math.abs(grey[n] - x)).toBeLessThan(1 / ONE));
    expect(texelsOf({ columns: 3, rows: 3 })).toBe(9 + 4 + 1);
  });

  it("are darker than what reflects everything", () => {
    const [, second] = levelsOf(imageOf(2, [255, 255, 255, 255]));
    expect(encoding()[second.bands[0]]).toBe(254);
  });

  it("have the mean opacity, and the colour of what is there", () => {
    const image = cutOutOf(4, [[200, 255], [50, 0], [100, 0], [7, 0], [100, 51], [9, 0], [3, 0], [0, 0]]);
    const [, second, third] = levelsOf(image);
    const there = (LINEAR[200] + 0.2 * LINEAR[100]) / 1.2;
    for (const [bands, opacity] of [[second.bands, 0.3], [third.bands, 0.15]] as const) {
      for (let band = 0; band < 3; ++band) expect(Math.abs(bands[band] / ONE - there)).toBeLessThan(1 / ONE);
      expect(Math.abs(bands[3] / ONE - opacity)).toBeLessThan(1 / ONE);
    }
    expect([...second.bands.subarray(4)]).toEqual([0, 0, 0, 0]); // holes only
  });

  it.each([[64, 64], [128, 8]])("of %d x %d with opacities all have the mean of what is there", (columns, rows) => {
    const image = noise(columns, rows, true);
    const sums = Array.from(levelsOf(image), ({ bands }) => {
      const isEncoded = bands instanceof Uint8Array;
      let [there, light] = [0, 0];
      for (let n = 0; n < bands.length; n += 4) {
        const opacity = bands[n + 3] / (isEncoded ? 255 : ONE);
        there += opacity;
        light += opacity * (isEncoded ? LINEAR[bands[n]] : bands[n] / ONE);
      }
      return { opacity: there / (bands.length / 4), colour: light / there };
    });
    for (const { opacity, colour } of sums) {
      // Each level rounds by half of 1 / 65535 at most, of seven; a colour by as much, and by what weights were rounded.
      expect(Math.abs(opacity - sums[0].opacity)).toBeLessThan(4 / ONE);
      expect(Math.abs(colour - sums[0].colour)).toBeLessThan(16 / ONE);
    }
  });

  it("are those of an image without opacities where all is there", () => {
    const opaque = noise(5, 3);
    const texels = Uint8Array.from({ length: 60 }, (_, n) => (n % 4 === 3 ? 255 : opaque.texels[3 * (n >> 2) + (n % 4)]));
    const levels = [...levelsOf({ ...opaque, hasOpacity: true, texels })];
    [...levelsOf(opaque)].forEach(({ bands }, level) => {
      const colours = levels[level].bands.filter((_, n) => n % 4 < 3);
      // An equal mean of four words may be rounded the other way.
      bands.forEach((word, n) => expect(Math.abs(colours[n] - word)).toBeLessThanOrEqual(1));
      const most = bands instanceof Uint8Array ? 255 : ONE;
      expect(levels[level].bands.filter((_, n) => n % 4 === 3).every((word) => word === most)).toBe(true);
    });
  });

  it("return each byte as it was", () => {
    const bytes = encoding();
    for (let byte = 0; byte < 255; ++byte) expect(bytes[Math.round(ONE * LINEAR[byte])]).toBe(byte);
  });
});

describe("a sheet", () => {
  const images = [noise(5, 3), noise(1, 1), noise(8, 8), noise(3, 4, true)];

  function texelsOn(sheet: Sheet): Uint8Array {
    const all = new Uint8Array(4 * sheet.width * sheet.height);
    let row = 0;
    for (const piece of piecesOf(images, sheet)) {
      expect(piece.row).toBe(row);
      all.set(piece.texels, 4 * sheet.width * row);
      row += piece.texels.length / (4 * sheet.width);
    }
    expect(row).toBe(sheet.height);
    return all;
  }

  const sheets = [sheetFor(images, 4096)!, { width: 7, height: 19 }, { width: 4, height: 33 }];
  it.each(sheets)("of $width x $height has every texel of every level where the table says", (sheet) => {
    const all = texelsOn(sheet);
    const table = tableOf(images.map((_, image) => ({ texture: create(TextureSchema, { image }) })), images);
    const bytes = encoding();
    images.forEach((image, n) => {
      let at = 4 * table[TABLE_WORDS * n];
      for (const { bands } of levelsOf(image))
        for (let k = 0; k < bands.length; k += bytesOf(image), at += 4) {
          const isEncoded = bands instanceof Uint8Array;
          const expected = [0, 1, 2].map((band) => (isEncoded ? bands[k + band] : bytes[bands[k + band]]));
          const opacity = !image.hasOpacity ? 255 : isEncoded ? bands[k + 3] : byteOfOpacity(bands[k + 3]);
          expect([...all.subarray(at, at + 4)]).toEqual([...expected, opacity]);
        }
    });
  });

  it("comes in pieces of whole rows", () => {
    const large = [noise(2048, 2048)];
    const sheet = sheetFor(large, 4096)!;
    const pieces = [...piecesOf(large, sheet)];
    expect(pieces.map(({ row }) => row)).toEqual([0, 512, 1024]);
    expect(sheet).toEqual({ width: 4096, height: Math.ceil(texelsOf(large[0]) / 4096) });
    const last = pieces.at(-1)!;
    expect(last.row + last.texels.length / 4 / 4096).toBe(sheet.height);
  });

  it("is as wide as it must be, and none where the graphics card holds none", () => {
    const large = { columns: 8192, rows: 8192, hasOpacity: false, texels: new Uint8Array(0) };
    expect(sheetFor([large], 16384)!.width).toBe(16384); // 4096 wide, it would be 21 000 high
    expect(sheetFor([large], 8192)).toBeUndefined();
  });

  it("has a table of what materials need of it", () => {
    const texture = create(TextureSchema, { image: 2, factor: { r: 0.5, g: 0.25, b: 1 }, wrapS: MIRROR });
    const absent = create(TextureSchema, { image: 4 });
    const table = tableOf([{}, { texture }, { texture: absent }], images);
    const [row, floats] = [table.subarray(TABLE_WORDS, 2 * TABLE_WORDS), new Float32Array(table.buffer, 4 * TABLE_WORDS)];
    expect([...row.subarray(0, 4)]).toEqual([texelsOf(images[0]) + 1, 8, 8, MIRROR + 4 * REPEAT]);
    expect([...floats.subarray(4, 8)]).toEqual([0.5, 0.25, 1, 0]);
    expect([table[1], table[2 * TABLE_WORDS + 1]]).toEqual([0, 0]);
  });
});
