// OBJ with its MTL files, as import/obj_import.cpp reads them: faces in the order of the `f` lines, polygons of any size.

import type { DroppedFiles } from "./dropped_files";
import { ImportError } from "./import_error";
import { linesOf, tripleOf, wordsOf, type Line } from "./lines";
import { readMtl, type MtlMaterial } from "./mtl";
import { DEFAULT_REFLECTANCE, SceneBuilder } from "./scene_builder";
import { isZero, meanColour, textured, type Bands } from "./texture_colour";
import { Unsupported } from "./unsupported";

export async function readObj(files: DroppedFiles): Promise<SceneBuilder> {
  const reader = new ObjReader(files);
  for (const line of linesOf(await files.scene.text())) await reader.take(line);
  return reader.finish();
}

class ObjReader {
  private readonly scene = new SceneBuilder();
  private readonly library = new Map<string, MtlMaterial>();
  private readonly libraryFiles = new Set<string>();
  private readonly missing = new Set<string>();
  private readonly slots = new Map<string, number>();
  private material = "";

  constructor(private readonly files: DroppedFiles) {}

  /** A promise only where a file must be read: most lines are vertices and faces. */
  take(line: Line): Promise<void> | undefined {
    const { keyword, rest } = line;
    if (keyword === "v") this.scene.addVertex(...tripleOf({ ...line, rest: withoutComment(rest) }));
    else if (keyword === "f") this.addFace(wordsOf(withoutComment(rest)));
    else if (keyword === "usemtl" && rest) this.material = rest;
    else if (keyword === "mtllib" && rest) return this.readLibrary(rest);
    return undefined;
  }

  async finish(): Promise<SceneBuilder> {
    const { scene } = this;
    scene.refuseVerticesBeyond(1);
    const because = `: not dropped with ${this.files.scene.name}`;
    for (const name of [...this.missing].sort()) scene.warnings.push(`material library '${name}' cannot be read${because}`);
    await this.fillMaterials();
    return scene;
  }

  private addFace(words: string[]): void {
    if (words.length < 3) return;
    this.scene.addFace(words.map((word) => this.vertexOf(word)), this.materialIndex());
  }

  /** Indices count from 1, or back from the newest vertex: -1. Those beyond the end are not refused yet: vertices may follow. */
  private vertexOf(word: string): number {
    const index = parseInt(word, 10) || 0;
    const count = this.scene.vertexCount;
    const vertex = index > 0 ? index - 1 : count + index;
    if (index === 0 || vertex < 0)
      throw new ImportError(`face ${this.scene.faceCount}`, `vertex index ${index} is out of range, ${count} vertices come before it`);
    return vertex;
  }

  /** Returns the place of the material in use; its colours are known when all libraries were read. */
  private materialIndex(): number {
    const known = this.slots.get(this.material);
    if (known !== undefined) return known;
    const index = this.scene.addDefaultMaterial();
    this.scene.materials[index].name = this.material;
    this.slots.set(this.material, index);
    return index;
  }

  /** A line is one name that may hold blanks, or several names, of which the first that is there is read. */
  private async readLibrary(rest: string): Promise<void> {
    // Exporters do not quote names with blanks: a name ends in .mtl.
    for (const name of rest.split(/(?<=\.mtl) +/i)) {
      if (this.libraryFiles.has(name)) continue;
      const file = this.files.find(name);
      if (!file) {
        this.missing.add(name);
        continue;
      }
      this.libraryFiles.add(name);
      for (const material of readMtl(await file.text(), name)) if (!this.library.has(material.name)) this.library.set(material.name, material);
    }
  }

  private async fillMaterials(): Promise<void> {
    const { warnings, materials } = this.scene;
    const unsupported = new Unsupported();
    for (const material of materials) {
      const found = this.library.get(material.name);
      if (found) {
        unsupported.add("transparentMaterials", found.isTransparent);
        unsupported.add("metals", found.metallic > 0.5);
        material.reflectance = await this.underTexture(found.diffuse, found.diffuseTexture, material.name);
        material.radiance = await this.underTexture(found.emission, found.emissionTexture, material.name);
      } else if (material.name !== "") {
        warnings.push(`material '${material.name}' is in no material library: grey, reflectance ${DEFAULT_REFLECTANCE[0]}`);
      } else {
        material.name = "default";
      }
    }
    unsupported.appendWarnings(warnings);
  }

  private async underTexture(factor: Bands, name: string, material: string): Promise<Bands> {
    if (name === "" || isZero(factor)) return factor;
    const path = name.replaceAll("\\", "/");
    const file = this.files.find(path);
    const mean = file && (await meanColour(new Uint8Array(await file.arrayBuffer())));
    return textured(factor, mean, `material '${material}': texture '${path}'`, this.scene.warnings);
  }
}

const withoutComment = (text: string) => text.replace(/#.*$/, "").trim();
