// The files that a person dropped together: a scene and its parts.

import { ImportError } from "./import_error";

/** The file's path within the dropped folder, or its name alone. */
export const pathOf = (file: File): string => file.webkitRelativePath || file.name;

/** Finds a scene's parts by the names that the scene gives them. */
export class DroppedFiles {
  private readonly byPath: Map<string, File>;
  private readonly folder: string;

  constructor(
    files: File[],
    readonly scene: File,
  ) {
    this.byPath = new Map(files.map((file) => [pathOf(file), file]));
    const path = pathOf(scene);
    this.folder = path.slice(0, path.lastIndexOf("/") + 1);
  }

  /** Returns the part of this relative path. Files that were dropped without their folders are found by the name alone. */
  find(name: string): File | undefined {
    if (reasonAgainst(name)) return undefined;
    const steps = name.split("/").filter((step) => step !== "" && step !== ".");
    return this.byPath.get(this.folder + steps.join("/")) ?? this.byPath.get(steps.at(-1) ?? "");
  }

  /** Returns the name that a relative URI of glTF stands for (RFC 3986). Throws ImportError as import/file_beside.cpp does. */
  nameOf(uri: string, place: string): string {
    const name = new TextDecoder().decode(percentDecoded(uri));
    const reason = reasonAgainst(name);
    if (reason) throw new ImportError(`${place} '${name}'`, reason);
    return name;
  }
}

/** Returns the bytes that a URI's text stands for. */
export function percentDecoded(uri: string): Uint8Array<ArrayBuffer> {
  const bytes = Array.from(new TextEncoder().encode(uri), (byte) => String.fromCharCode(byte)).join("");
  const text = bytes.replace(/%([0-9a-f]{2})/gi, (_, digits) => String.fromCharCode(parseInt(digits, 16)));
  return Uint8Array.from(text, (c) => c.charCodeAt(0));
}

/** Returns why a name cannot be that of a file in the scene's folder or below it; empty if it can. */
function reasonAgainst(name: string): string {
  if (name === "") return "names no file";
  if ([...name].some((c) => c < " ")) return "has control characters";
  if (name.includes(":")) return "is a URL or names a drive: only files beside the scene are read";
  if (/^[/\\]/.test(name)) return "is an absolute path: only files beside the scene are read";
  if (name.split(/[/\\]/).includes("..")) return "leaves the folder of the scene";
  return "";
}
