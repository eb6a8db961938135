// Images of textures on their way from the worker to the room.

import { reasonOf } from "../api";
import type { FromWorker } from "../messages";
import type { Room } from "../view/room";
import { byId, listItem } from "./dom";

/** Among the scene's warnings, where textures cannot be shown. */
let warning: HTMLLIElement | undefined;

export function takeImages(room: Room, message: Extract<FromWorker, { kind: "sheet" | "piece" | "no images" }>): void {
  if (message.kind === "piece") return room.takePiece(message.piece);
  if (message.kind === "no images") return warn(message.reason);
  try {
    room.beginSheet(message.sheet, message.table);
  } catch (error) {
    warn(reasonOf(error));
  }
}

export function withdrawWarning(): void {
  warning?.remove();
  warning = undefined;
}

function warn(reason: string): void {
  withdrawWarning();
  warning = listItem(`Textures are shown by their mean colours: ${reason}`);
  byId("warnings").append(warning);
}
