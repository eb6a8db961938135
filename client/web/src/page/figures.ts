// What is told in words and numbers.

import { PlannedFeature_Kind, type Plan, type Step } from "../gen/alvor/v1/solve_service_pb";
import type { Counters, Reading } from "../messages";
import { byId, bytes, listItem, round } from "./dom";
import { secondsOf } from "./time";
import { irradianceName, irradianceUnit, radiosityName, radiosityUnit } from "./units";

const compact = new Intl.NumberFormat("en", { notation: "compact", maximumSignificantDigits: 3 });

export function showPlan(plan: Plan): void {
  const lines = plan.features.map((feature) => {
    const name = PlannedFeature_Kind[feature.kind].toLowerCase().replaceAll("_", " ");
    return `${name}: ${feature.on ? "on" : "off"}. ${feature.reason}; ${feature.cost}`;
  });
  const text = lines.join("");
  if (byId("features").textContent !== text) byId("features").replaceChildren(...lines.map(listItem));
}

/** `latency`: of the newest frame, from its arrival to the screen, ms. */
export function showCounters(step: Step, counters: Counters | undefined, latency: number): void {
  const seconds = secondsOf(step.elapsed);
  const rows: [string, string][] = [
    ["Estimated error", `${(100 * step.estimatedError).toPrecision(3)} %`],
    ["Unshot light", `${round(100 * step.unshotFraction)} %`],
    ["Run time", `${round(seconds)} s`],
    ["Leaves", step.leaves.toLocaleString()],
    ["Rays", Number(step.rays).toLocaleString()],
    ["Rays a second", seconds > 0 ? compact.format(Number(step.rays) / seconds) : ""],
    ["Received", counters ? bytes(counters.bytes) : ""],
    ["Revision", counters ? String(counters.revision) : ""],
    ["Frame to screen", `${Math.round(latency)} ms`],
    ["Newest frame", counters ? `${round((performance.timeOrigin + performance.now() - counters.arrived) / 1000)} s ago` : ""],
  ];
  const cells = rows.flatMap(([term, text]) => {
    const dt = document.createElement("dt");
    const dd = document.createElement("dd");
    dt.textContent = term;
    dd.textContent = text;
    return [dt, dd];
  });
  byId("counters").replaceChildren(...cells);
}

export function showReading(reading: Reading | null): void {
  byId("reading").hidden = reading === null;
  if (!reading) return;
  const bands = (values: number[]) => values.map(round).join(", ");
  const { x, y, z } = reading.place;
  const faces = reading.faces.length > 1 ? `Faces ${reading.faces.join(" and ")}` : `Face ${reading.faces}`;
  byId("reading").textContent = [
    `${irradianceName()} ${bands(reading.irradiance)}${reading.error === undefined ? "" : ` ± ${round(reading.error)}`} ${irradianceUnit()}`,
    `${radiosityName()} ${bands(reading.radiosity)} ${radiosityUnit()}`,
    `${faces}, level ${reading.level}, ${reading.material}`,
    `at ${bands([x, y, z])} m`,
  ].join("\n");
}
