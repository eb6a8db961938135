// What the page and the worker that mirrors a solve tell each other.

import type { Step } from "./gen/alvor/v1/solve_service_pb";
import type { SurfaceChange } from "./mirror/surface";
import type { Piece, Sheet } from "./textures/sheet";

export interface Vector {
  x: number;
  y: number;
  z: number;
}

export type ToWorker =
  /** `longestSide`: of textures that the graphics card holds, texels. */
  | { kind: "watch"; origin: string; solve: string; token: string; rate: number; longestSide: number }
  /** A compact solution file. */
  | { kind: "open"; file: Blob; longestSide: number }
  /** The last change is on the screen: the next may come. */
  | { kind: "drawn" }
  | { kind: "probe"; origin: Vector; direction: Vector };

/** Three numbers: r, g, b, or x, y, z. */
export type Bands = [number, number, number];

/** What of a scene can be edited, as it was submitted. */
export interface Parts {
  /** Of the box around all that was submitted, metres from the middle of the mesh. */
  low: Bands;
  high: Bands;
  /** `position`: where a person can place it. `addedWith`: the added object that it came with. */
  lights: { name: string; intensity: Bands; isFar: boolean; position?: Bands; addedWith?: string }[];
  /**
   * Objects with faces, their own or of objects that hang from them. `parent`: what it hangs from. `isAdded`: by an edit, which may have been
   * taken back. `shines`: faces of it emit, or lights came with it. `isRoom`: it is as long and wide as the scene. `low`, `high`: of the box around it, metres from
   * the middle of the mesh.
   */
  objects: { name: string; parent?: string; isAdded: boolean; shines: boolean; isRoom: boolean; low: Bands; high: Bands }[];
  materials: { name: string; emission: Bands; reflectance: Bands; hasTexture: boolean }[];
}

/** Of the lit surfaces, for exposure and scales; 0 where nothing is lit. */
export interface Brightness {
  exposure: number;
  lowIrradiance: number;
  highIrradiance: number;
  lowError: number;
  highError: number;
}

export interface Counters {
  revision: number;
  bytes: number;
  /** When the newest frame arrived, in ms of performance.timeOrigin + now(). */
  arrived: number;
  /** How long it took to decode and apply it, and to make ready what is drawn of it, ms. */
  applying: number;
  preparing: number;
}

export interface Reading {
  /** Numbers of the scene's faces there: one, or the two triangles that the server joined to a quad. */
  faces: number[];
  /** The name of the object that it belongs to. */
  object?: string;
  level: number;
  material: string;
  place: Vector;
  irradiance: [number, number, number];
  /** Told error of the mean of its bands; nothing if none was told. */
  error?: number;
  radiosity: [number, number, number];
}

export type FromWorker =
  | {
      kind: "mesh";
      centre: [number, number, number];
      extent: number;
      corners: Float32Array;
      counts: Uint8Array;
      materials: Float32Array;
      /** Share that comes through scattered, r, g, b, and five zeros of each material; nothing if no root is translucent. */
      transmittances?: Float32Array;
      isZUp: boolean;
      isPhotometric: boolean;
      parts: Parts;
    }
  /** Edits have changed materials: those of "mesh" anew. */
  | { kind: "look"; materials: Float32Array; transmittances?: Float32Array }
  | { kind: "change"; change: SurfaceChange; brightness: Brightness; counters: Counters }
  /** The images of the mesh's textures are here, and come piece by piece. `table`: see tableOf(). */
  | { kind: "sheet"; sheet: Sheet; table: Uint32Array<ArrayBuffer> }
  | { kind: "piece"; piece: Piece }
  /** They do not come: surfaces keep their mean colours. */
  | { kind: "no images"; reason: string }
  | { kind: "steps"; steps: Step[]; isFirst: boolean }
  | { kind: "connection"; state: "connected" | "lost" | "resumed" | "begun anew" | "closing"; reason: string }
  /** The solve has ended; it may be edited, and goes on then. `isShown`: no "change" is still to come of what is known. */
  | { kind: "ended"; isShown: boolean }
  | { kind: "refused"; reason: string; needsToken: boolean }
  | { kind: "probed"; reading: Reading | null };
