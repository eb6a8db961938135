// How a person chose to look at the room.

import type { Brightness } from "../messages";
import type { Look, Room, Tone } from "../view/room";
import { byId, input, select } from "./dom";
import { showLegend } from "./legend";

/** Of the newest state, or of when a person chose to keep it. */
let exposure = 1;

export const heldExposure = () => exposure;
export const holdExposure = (held: number) => void (exposure = held);

export function lookOf(brightness: Brightness): Look {
  if (input("automatic").checked) exposure = brightness.exposure;
  const isOfErrors = select("show").value === "error";
  const low = isOfErrors ? brightness.lowError : brightness.lowIrradiance;
  const high = Math.max(isOfErrors ? brightness.highError : brightness.highIrradiance, 1e-30);
  const logarithmic = select("scale").value === "log";
  return {
    falseColour: select("show").value !== "room",
    isOfErrors,
    tone: select("tone").value as Tone,
    exposure: exposure * 2 ** input("exposure").valueAsNumber,
    low: logarithmic ? Math.max(low, high * 1e-4) : 0,
    high,
    logarithmic,
    mesh: input("mesh").checked,
    ambient: input("ambient").checked,
  };
}

function comparison(): "off" | "ambient" | "pinned" {
  return select("comparison").value as "off" | "ambient" | "pinned";
}

export function draw(room: Room, brightness: Brightness): void {
  const now = lookOf(brightness);
  room.render(now, comparison(), input("split").valueAsNumber);
  byId("legend").hidden = !now.falseColour;
  if (now.falseColour) showLegend(now);
  byId("compare").hidden = comparison() === "off";
  byId("split-left").textContent = comparison() === "ambient" ? "Without ambient term" : "The moment kept";
  byId("split-right").textContent = comparison() === "ambient" ? "With ambient term" : "Now";
}
