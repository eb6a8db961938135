import { describe, expect, it } from "vitest";
import { linearTable } from "../../src/files/srgb";
import { meanColour } from "../../src/files/texture_colour";
import { bytesOf } from "./files";
import { pngOf, type Picture } from "./png";

const linear = (byte: number) => linearTable(255)[byte];
const mean = (...bytes: number[]) => bytes.map(linear).reduce((a, b) => a + b) / bytes.length;
const PALETTE = [255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255];

// Two pixels wide, two rows, unless said otherwise.
const PICTURES: [string, Partial<Picture>, number[]][] = [
  ["RGB", { kind: 2, rows: [0, 10, 20, 30, 40, 50, 60, 0, 70, 80, 90, 100, 110, 120] }, [mean(10, 40, 70, 100), mean(20, 50, 80, 110), mean(30, 60, 90, 120)]],
  ["RGB with each row's differences", { kind: 2, rows: [1, 10, 20, 30, 30, 30, 30, 2, 60, 60, 60, 60, 60, 60] }, [mean(10, 40, 70, 100), mean(20, 50, 80, 110), mean(30, 60, 90, 120)]],
  ["grey with the filters average and Paeth", { kind: 0, rows: [3, 10, 15, 4, 5, 250] }, [mean(10, 20, 15, 14), mean(10, 20, 15, 14), mean(10, 20, 15, 14)]],
  ["RGB with alpha 0, which does not count", { kind: 6, rows: [0, 200, 0, 0, 0, 0, 200, 0, 255, 0, 200, 0, 0, 0, 0, 200, 0, 255] }, [mean(200, 0, 200, 0), mean(0, 200, 0, 200), 0]],
  ["grey of one bit", { kind: 0, depth: 1, rows: [0, 0b10000000, 0, 0b11000000] }, [0.75, 0.75, 0.75]],
  ["a palette of two bits", { kind: 3, depth: 2, palette: PALETTE, rows: [0, 0b00010000, 0, 0b10110000] }, [0.5, 0.5, 0.5]],
  ["grey of 16 bits", { kind: 0, depth: 16, rows: [0, 255, 255, 0, 0, 0, 255, 255, 0, 0] }, [0.5, 0.5, 0.5]],
  ["interlaced", { kind: 0, interlaced: true, rows: [0, 255, 0, 0, 0, 255, 0] }, [0.5, 0.5, 0.5]],
];

describe("a texture's mean colour", () => {
  it.each(PICTURES)("is that of its pixels in linear light: %s", async (_, picture, expected) => {
    const colour = await meanColour(pngOf({ width: 2, height: 2, depth: 8, kind: 2, rows: [], ...picture }));
    colour!.forEach((band, k) => expect(band).toBeCloseTo(expected[k], 12));
  });

  it("is not known of a picture that breaks off, or is none", async () => {
    const whole = new Uint8Array(bytesOf("tests/import/blender/files/wall paper.png"));
    expect(await meanColour(whole)).toBeDefined();
    expect(await meanColour(whole.slice(0, 900))).toBeUndefined();
    expect(await meanColour(new TextEncoder().encode("no picture"))).toBeUndefined();
    expect(await meanColour(new Uint8Array())).toBeUndefined();
  });
});
