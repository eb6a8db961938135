// The images of textures on the graphics card.

import * as THREE from "three";
import type { Piece, Sheet } from "../textures/sheet";
import { materialTable } from "./material_table";

/** A sheet of texels that is written piece by piece; nothing of it stays in the page's own memory. */
export class ImageSheet {
  readonly texels: THREE.DataTexture;
  readonly table: THREE.DataTexture;
  private rowsToCome: number;

  /** Throws if the graphics card has no memory left. */
  constructor(
    private readonly renderer: THREE.WebGLRenderer,
    private readonly sheet: Sheet,
    table: Uint32Array,
  ) {
    this.table = materialTable(table);
    this.rowsToCome = sheet.height;
    this.texels = newTexels(null, sheet.width, sheet.height);
    this.texels.source.dataReady = false; // rows follow: write()
    const gl = renderer.getContext();
    while (gl.getError() !== gl.NO_ERROR); // those of others
    renderer.initTexture(this.texels);
    if (gl.getError() === gl.NO_ERROR) return;
    this.dispose();
    throw new Error("the graphics card has no memory left");
  }

  get isWhole(): boolean {
    return this.rowsToCome === 0;
  }

  write({ row, texels }: Piece): void {
    const rows = texels.length / (4 * this.sheet.width);
    this.renderer.copyTextureToTexture(newTexels(texels, this.sheet.width, rows), this.texels, null, new THREE.Vector2(0, row));
    this.rowsToCome -= rows;
  }

  dispose(): void {
    this.texels.dispose();
    this.table.dispose();
  }
}

/** The GPU decodes sRGB: shaders see linear values. */
function newTexels(data: Uint8Array<ArrayBuffer> | null, width: number, height: number): THREE.DataTexture {
  const texture = new THREE.DataTexture(data, width, height, THREE.RGBAFormat, THREE.UnsignedByteType);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.needsUpdate = true;
  return texture;
}
