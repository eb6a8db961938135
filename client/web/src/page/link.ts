// The address of a solve as it is looked at: `#scenes/…/solves/…?show=irradiance&camera=…`. Who opens it sees the same.

import { input, select } from "./dom";
import { heldExposure, holdExposure } from "./viewing";

const SELECTS = ["show", "tone", "scale", "camera", "comparison"];
const CHECKS = ["automatic", "mesh", "ambient"];
const RANGES = ["exposure", "split"];
const DIGITS = 5;
// A moment that was kept is in one page only.
const OF_THIS_PAGE = "pinned";

const defaultOf = (id: string) => [...select(id).options].find((option) => option.defaultSelected)?.value ?? select(id).options[0].value;
const short = (x: number) => String(Number(x.toPrecision(DIGITS)));

/** Returns the part of the address before a view: a solve's name, or empty. */
export const solveIn = (hash: string) => decodeURIComponent(hash.slice(1).split("?")[0]);

/** Returns the view in an address; undefined for one that does not speak of views. */
export function viewIn(hash: string): URLSearchParams | undefined {
  const mark = hash.indexOf("?");
  return mark < 0 ? undefined : new URLSearchParams(hash.slice(mark + 1));
}

/** `camera`: where a person moved it; undefined as the page framed the room. */
export function addressOf(solve: string, camera: number[] | undefined): string {
  const view = new URLSearchParams();
  for (const id of SELECTS) if (![defaultOf(id), OF_THIS_PAGE].includes(select(id).value)) view.set(id, select(id).value);
  for (const id of CHECKS) if (input(id).checked !== input(id).defaultChecked) view.set(id, input(id).checked ? "1" : "0");
  for (const id of RANGES) if (input(id).value !== input(id).defaultValue) view.set(id, input(id).value);
  if (!input("automatic").checked) view.set("held", short(heldExposure()));
  if (camera) view.set("eye", camera.map(short).join("_"));
  return `#${solve}${view.size > 0 ? `?${view}` : ""}`;
}

/** Sets the controls as the view says. Returns the camera of the view. */
export function applyView(view: URLSearchParams): number[] | undefined {
  for (const id of SELECTS) {
    const wanted = view.get(id) ?? "";
    const isThere = [...select(id).options].some(({ value }) => value === wanted && value !== OF_THIS_PAGE);
    select(id).value = isThere ? wanted : defaultOf(id);
  }
  for (const id of CHECKS) input(id).checked = view.has(id) ? view.get(id) === "1" : input(id).defaultChecked;
  for (const id of RANGES) input(id).value = view.get(id) ?? input(id).defaultValue;
  const held = Number(view.get("held"));
  if (held > 0 && Number.isFinite(held)) holdExposure(held);
  const camera = (view.get("eye") ?? "").split("_").map(Number);
  return camera.length === 6 && camera.every(Number.isFinite) ? camera : undefined;
}
