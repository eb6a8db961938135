// Files of tests, as a browser would hand them over.

import { File } from "node:buffer";
import { readFileSync } from "node:fs";
import { basename } from "node:path";
import type { readSceneFiles } from "../../src/scene_files";

export type BrowserFile = Parameters<typeof readSceneFiles>[0][number];

export const file = (name: string, content: string | Uint8Array) => new File([content], name) as unknown as BrowserFile;

const ROOT = new URL("../../../../", import.meta.url);

/** Bytes of a file of the repository. */
export const bytesOf = (path: string) => readFileSync(new URL(path, ROOT));

export const fileOf = (path: string) => file(basename(path), bytesOf(path));
