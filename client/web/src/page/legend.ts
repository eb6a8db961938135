// Draws the legend of the colours of irradiance or of its error.

import { colourMap } from "../view/colour_map";
import type { Look } from "../view/room";
import { byId, listItem, round } from "./dom";
import { errorName, irradianceName, irradianceUnit } from "./units";

const TICKS = 5;

export function showLegend({ low, high, logarithmic, isOfErrors }: Look): void {
  const bar = byId<HTMLCanvasElement>("legend-bar");
  const pen = bar.getContext("2d")!;
  for (let y = 0; y < bar.height; ++y) {
    pen.fillStyle = `rgb(${colourMap(1 - y / (bar.height - 1)).join()})`;
    pen.fillRect(0, y, bar.width, 1);
  }
  byId("legend-title").textContent = `${isOfErrors ? errorName() : irradianceName()}, ${irradianceUnit()}`;
  const values = Array.from({ length: TICKS }, (_, n) => {
    const place = 1 - n / (TICKS - 1);
    return logarithmic ? low * (high / low) ** place : low + place * (high - low);
  });
  byId("legend-ticks").replaceChildren(...values.map((value) => listItem(round(value))));
}
