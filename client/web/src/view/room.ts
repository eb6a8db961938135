// The room on the screen: the surface's slots, one draw call.

import * as THREE from "three";
import type { Vector } from "../messages";
import type { SurfaceChange } from "../mirror/surface";
import type { Piece, Sheet } from "../textures/sheet";
import { colourMap } from "./colour_map";
import { ImageSheet } from "./image_sheet";
import { materialTable } from "./material_table";
import { FRAGMENT, VERTEX, type ShaderPart } from "./shaders";
import { Slots } from "./slots";

export type Tone = "aces" | "reinhard" | "linear";

/** How the surface is shown. */
export interface Look {
  /** By false colour: irradiance, or its told error. */
  falseColour: boolean;
  isOfErrors: boolean;
  tone: Tone;
  /** Factor from radiosity to what the tone curve takes. */
  exposure: number;
  /** Irradiance or error of the scale's ends, W/m2. */
  low: number;
  high: number;
  logarithmic: boolean;
  mesh: boolean;
  ambient: boolean;
}

const TONES: Record<Tone, number> = { aces: 0, reinhard: 1, linear: 2 };

/** Without a graphics card smooth edges would cost half of the frames. */
function isDrawnByProcessor(): boolean {
  const gl = document.createElement("canvas").getContext("webgl2");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = info ? String(gl!.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}

export class Room {
  readonly camera = new THREE.PerspectiveCamera(40, 1, 0.01, 100);
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private slots = new Slots();
  private readonly surface: THREE.Mesh<THREE.BufferGeometry, THREE.RawShaderMaterial>;
  private pinned?: THREE.Mesh<THREE.BufferGeometry, THREE.RawShaderMaterial>;
  private sheet?: ImageSheet;
  private ambient = new THREE.Vector3();
  private pinnedAmbient = new THREE.Vector3();

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !isDrawnByProcessor(), preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    this.renderer.autoClear = false;
    this.surface = this.drawable(this.slots.geometry, newMaterial());
    canvas.addEventListener("webglcontextrestored", () => this.dropSheet()); // its texels were nowhere else
  }

  /** Longest side of a texture that the graphics card holds. */
  get longestSide(): number {
    return this.renderer.capabilities.maxTextureSize;
  }

  /** Eight floats of each: `materials`: emission, mean of what goes straight through, reflectance and 0; `transmittances`: see FromWorker. */
  setMaterials(materials: Float32Array, transmittances?: Float32Array): void {
    const table = materialTable(materials);
    const { uniforms } = this.surface.material;
    uniforms.materials.value?.dispose();
    uniforms.materials.value = table;
    uniforms.materialsWide.value = table.image.width / 2;
    uniforms.transmittances.value?.dispose();
    uniforms.transmittances.value = transmittances ? materialTable(transmittances) : null;
  }

  /** Images of textures come: takePiece(). `table`: see tableOf(). Throws if the graphics card has no memory left. */
  beginSheet(sheet: Sheet, table: Uint32Array): void {
    this.dropSheet();
    this.sheet = new ImageSheet(this.renderer, sheet, table);
  }

  /** Shows textures as soon as all pieces have come; until then, mean colours. */
  takePiece(piece: Piece): void {
    this.sheet?.write(piece);
    if (this.sheet?.isWhole) this.useSheet(this.sheet);
  }

  /** Turns what is drawn so that the scene's upward axis is the picture's. */
  setUp(isZUp: boolean): void {
    this.scene.rotation.x = isZUp ? -Math.PI / 2 : 0;
    this.scene.updateMatrixWorld();
  }

  /** Draws something besides the surface, in the scene's axes. */
  add(thing: THREE.Object3D): void {
    this.scene.add(thing);
  }

  /** A new surface comes. */
  begin(): void {
    this.slots.dispose();
    this.slots = new Slots();
    this.surface.geometry = this.slots.geometry;
    this.unpin();
    this.dropSheet();
  }

  take(change: SurfaceChange): void {
    this.slots.take(change);
    this.compile("COLOURED", change.colours !== undefined);
    this.compile("TRANSLUCENT", change.transmitted !== undefined);
    this.compile("TOLD", change.errors !== undefined);
  }

  get slotCount(): number {
    return this.slots.count;
  }

  setAmbient({ r, g, b }: { r: number; g: number; b: number }): void {
    this.ambient.set(r, g, b);
  }

  /** Keeps what is seen now, for comparison. */
  pin(): void {
    this.unpin();
    this.pinned = this.drawable(this.slots.copy(), this.surface.material);
    this.pinnedAmbient.copy(this.ambient);
  }

  unpin(): void {
    if (!this.pinned) return;
    this.scene.remove(this.pinned);
    this.pinned.geometry.dispose();
    this.pinned = undefined;
  }

  /** Left of `split` (0 to 1) is what was pinned, or the surface without the ambient term. */
  render(look: Look, comparison: "off" | "ambient" | "pinned", split: number): void {
    this.fit();
    this.renderer.setScissorTest(false);
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.clear();
    const { width, height } = this.renderer.getSize(new THREE.Vector2());
    if (comparison === "off") return this.draw(look, this.surface);
    const edge = Math.round(split * width);
    this.renderer.setScissorTest(true);
    this.renderer.setScissor(0, 0, edge, height);
    if (comparison === "ambient") this.draw({ ...look, ambient: false }, this.surface);
    else this.draw(look, this.pinned ?? this.surface);
    this.renderer.setScissor(edge, 0, width - edge, height);
    this.draw(look, this.surface);
  }

  /** From the eye through a point of the canvas, 0 to 1 from its upper left corner; in the scene's axes. */
  ray(x: number, y: number): { origin: Vector; direction: Vector } {
    const through = new THREE.Vector3(2 * x - 1, 1 - 2 * y, 0.5).unproject(this.camera);
    const turned = this.scene.matrixWorld.clone().invert();
    const direction = through.sub(this.camera.position).normalize().transformDirection(turned);
    return { origin: this.camera.position.clone().applyMatrix4(turned), direction };
  }

  /** As drawn; bands as float32 attributes, as `alvor solve` writes them. */
  exported(): THREE.BufferGeometry {
    return this.slots.copy();
  }

  /** Without a sheet, the shaders have no part that looks at images. */
  private useSheet(sheet: ImageSheet | undefined): void {
    const { uniforms } = this.surface.material;
    uniforms.sheet.value = sheet?.texels ?? null;
    uniforms.textures.value = sheet?.table ?? null;
    this.compile("TEXTURED", sheet !== undefined);
  }

  /** Compiles a part of the shaders in or out. */
  private compile(part: ShaderPart, isIn: boolean): void {
    const { material } = this.surface;
    if (part in material.defines === isIn) return;
    if (isIn) material.defines[part] = "";
    else delete material.defines[part];
    material.needsUpdate = true;
  }

  private dropSheet(): void {
    if (!this.sheet) return;
    this.useSheet(undefined);
    this.sheet.dispose();
    this.sheet = undefined;
  }

  private draw(look: Look, which: THREE.Mesh<THREE.BufferGeometry, THREE.RawShaderMaterial>): void {
    this.surface.visible = which === this.surface;
    if (this.pinned) this.pinned.visible = which === this.pinned;
    const { uniforms } = which.material;
    uniforms.ambient.value = !look.ambient ? new THREE.Vector3() : which === this.surface ? this.ambient : this.pinnedAmbient;
    uniforms.falseColour.value = look.falseColour;
    uniforms.isOfErrors.value = look.isOfErrors;
    uniforms.tone.value = TONES[look.tone];
    uniforms.exposure.value = look.exposure;
    uniforms.scale.value.set(look.low, look.high);
    uniforms.logarithmic.value = look.logarithmic;
    uniforms.outlines.value = look.mesh;
    which.material.uniformsNeedUpdate = true;
    this.renderer.render(this.scene, this.camera);
  }

  private fit(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const size = this.renderer.getSize(new THREE.Vector2());
    if (width === 0 || height === 0 || (size.x === width && size.y === height)) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  /** The material is one for all: draw() sets it for the one that is visible. */
  private drawable(
    geometry: THREE.BufferGeometry,
    material: THREE.RawShaderMaterial,
  ): THREE.Mesh<THREE.BufferGeometry, THREE.RawShaderMaterial> {
    const mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = false;
    this.scene.add(mesh);
    return mesh;
  }
}

function newMaterial(): THREE.RawShaderMaterial {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms: {
      materials: { value: null },
      materialsWide: { value: 1 },
      transmittances: { value: null },
      textures: { value: null },
      sheet: { value: null },
      colours: { value: colourTexture() },
      ambient: { value: new THREE.Vector3() },
      falseColour: { value: false },
      isOfErrors: { value: false },
      tone: { value: 0 },
      exposure: { value: 1 },
      scale: { value: new THREE.Vector2(0, 1) },
      logarithmic: { value: false },
      outlines: { value: false },
    },
  });
}

function colourTexture(): THREE.DataTexture {
  const data = new Uint8Array(4 * 256);
  for (let n = 0; n < 256; ++n) data.set([...colourMap(n / 255), 255], 4 * n);
  const texture = new THREE.DataTexture(data, 256, 1);
  texture.magFilter = texture.minFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}
