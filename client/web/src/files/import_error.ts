/** Why a reader refuses a file, as client/import_error.h. The message does not name the file. */
export class ImportError extends Error {
  constructor(place: string, reason: string) {
    super(place === "file" || place === "scene" ? reason : `${place}: ${reason}`);
  }
}
