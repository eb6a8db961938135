// Material libraries of OBJ, as import/obj_import.cpp reads them.

import { linesOf, tripleOf, wordsOf } from "./lines";
import type { Bands } from "./texture_colour";

export interface MtlMaterial {
  name: string;
  diffuse: Bands;
  emission: Bands;
  /** Names of files; empty for none. */
  diffuseTexture: string;
  emissionTexture: string;
  isTransparent: boolean;
  metallic: number;
}

/** `file` names the library where a number is wrong. Throws ImportError. */
export function readMtl(text: string, file: string): MtlMaterial[] {
  const materials: Reading[] = [];
  for (const line of linesOf(text)) {
    if (line.keyword === "newmtl" && line.rest) materials.push(new Reading(line.rest));
    if (line.keyword === "Kd" || line.keyword === "Ke") {
      const triple = tripleOf(line, file);
      materials.at(-1)?.setColour(line.keyword, triple);
    } else {
      materials.at(-1)?.set(line.keyword, line.rest);
    }
  }
  return materials.map((material) => material.finish());
}

class Reading implements MtlMaterial {
  diffuse: Bands = [0, 0, 0];
  emission: Bands = [0, 0, 0];
  diffuseTexture = "";
  emissionTexture = "";
  metallic = 0;
  private opacity = 1;
  private hasAlphaTexture = false;
  private hasDiffuse = false;
  private hasEmission = false;
  private hasOpacity = false;

  constructor(readonly name: string) {}

  get isTransparent(): boolean {
    return this.opacity < 1 || this.hasAlphaTexture;
  }

  setColour(keyword: "Kd" | "Ke", colour: Bands): void {
    if (keyword === "Ke") (this.emission = colour), (this.hasEmission = true);
    else (this.diffuse = colour), (this.hasDiffuse = true);
  }

  /** A texture without a colour (Blender writes such) counts whole. */
  finish(): this {
    if (this.diffuseTexture && !this.hasDiffuse) this.diffuse = [1, 1, 1];
    if (this.emissionTexture && !this.hasEmission) this.emission = [1, 1, 1];
    return this;
  }

  set(keyword: string, rest: string): void {
    if (keyword === "map_Kd") this.diffuseTexture = textureOf(rest);
    else if (keyword === "map_Ke") this.emissionTexture = textureOf(rest);
    else if (keyword === "map_d") this.hasAlphaTexture = true;
    else if (keyword === "Pm") this.metallic = parseFloat(rest) || 0;
    else if (keyword === "d") (this.opacity = numberOf(rest)), (this.hasOpacity = true);
    else if (keyword === "Tr" && !this.hasOpacity) this.opacity = 1 - numberOf(rest);
  }
}

const numberOf = (text: string) => parseFloat(text) || 0;

// Options before the name of a texture, and how many words follow each.
const OPTIONS: Record<string, number> = {
  "-blendu": 1, "-blendv": 1, "-clamp": 1, "-boost": 1, "-bm": 1, "-o": 3, "-s": 3, "-t": 3, "-type": 1, "-texres": 1,
  "-imfchan": 1, "-mm": 2, "-colorspace": 1,
};

/** Returns the name behind the options; it may hold blanks. */
function textureOf(rest: string): string {
  const option = wordsOf(rest)[0] ?? "";
  if (!(option in OPTIONS)) return rest;
  const words = `\\S+(?:\\s+|$)`.repeat(1 + OPTIONS[option]);
  return textureOf(rest.replace(new RegExp(`^${words}`), ""));
}
