// The controls of sun and sky: a sky, a place, a day and the time of day.

import type { MessageInitShape } from "@bufbuild/protobuf";
import { timestampFromMs } from "@bufbuild/protobuf/wkt";
import { Daylight_Sky, type Daylight, type DaylightSchema } from "../gen/alvor/v1/scene_service_pb";
import { byId, input, select } from "./dom";

export type SkyName = "clear" | "overcast" | "sun" | "dark";

/** What a person has set. */
export interface DaylightChoice {
  sky: SkyName;
  /** Degrees; north and east are positive. */
  latitude: number;
  longitude: number;
  /** "2026-06-21" */
  date: string;
  /** Of the day, by a clock that is so many hours ahead of UTC. */
  minutes: number;
  hoursFromUtc: number;
}

// The number of the CIE sky that is called clear (ISO 15469).
const CLEAR = 12;
const MINUTE = 60_000;
// Times that the server takes.
const FIRST = Date.UTC(1900, 0, 1);
const LAST = Date.UTC(2100, 0, 1);

const timeOf = ({ date, minutes, hoursFromUtc }: DaylightChoice) => Date.parse(`${date}T00:00Z`) + MINUTE * (minutes - 60 * hoursFromUtc);

/** Returns the message; undefined where a field that counts is empty or out of range. */
export function daylightOf(choice: DaylightChoice): MessageInitShape<typeof DaylightSchema> | undefined {
  const { sky, latitude, longitude } = choice;
  if (sky === "dark") return {};
  if (sky === "overcast") return { sky: Daylight_Sky.OVERCAST };
  const time = Math.round(timeOf(choice));
  const isKnown = Math.abs(latitude) <= 90 && Math.abs(longitude) <= 180 && Math.abs(choice.hoursFromUtc) <= 14 && time >= FIRST && time < LAST;
  if (!isKnown) return undefined;
  const sunTime = { latitudeDegrees: latitude, longitudeDegrees: longitude, time: timestampFromMs(time) };
  return sky === "sun" ? { sunTime } : { sunTime, sky: Daylight_Sky.CIE, cieNumber: CLEAR };
}

/** Returns the choice that a message tells; what it does not tell stays. */
export function choiceOf(daylight: Daylight, before: DaylightChoice): DaylightChoice {
  const { sky, sunTime } = daylight;
  if (sky === Daylight_Sky.OVERCAST || sky === Daylight_Sky.UNIFORM) return { ...before, sky: "overcast" };
  const hasSun = sunTime !== undefined || daylight.sunAzimuthDegrees !== undefined;
  const shown = sky !== Daylight_Sky.SKY_UNSPECIFIED ? "clear" : hasSun ? "sun" : "dark";
  const hours = before.hoursFromUtc;
  if (!sunTime || !Number.isFinite(hours)) return { ...before, sky: shown };
  const local = new Date(Number(sunTime.time?.seconds ?? 0n) * 1000 + 60 * MINUTE * hours);
  return {
    sky: shown,
    latitude: sunTime.latitudeDegrees,
    longitude: sunTime.longitudeDegrees,
    date: local.toISOString().slice(0, 10),
    minutes: 60 * local.getUTCHours() + local.getUTCMinutes(),
    hoursFromUtc: hours,
  };
}

/** Returns "09:05". */
export function clockOf(minutes: number): string {
  return [Math.floor(minutes / 60), minutes % 60].map((part) => String(part).padStart(2, "0")).join(":");
}

const NUMBERS = { latitude: "edit-latitude", longitude: "edit-longitude", minutes: "edit-time", hoursFromUtc: "edit-utc" } as const;

export class DaylightControls {
  /** `changed` is called with what is to shine. */
  constructor(changed: (daylight: MessageInitShape<typeof DaylightSchema>) => void) {
    const now = new Date();
    const hoursFromUtc = -now.getTimezoneOffset() / 60;
    const date = new Date(now.getTime() + 60 * MINUTE * hoursFromUtc).toISOString().slice(0, 10);
    this.set({ sky: "clear", latitude: 50, longitude: ((15 * hoursFromUtc + 540) % 360) - 180, date, minutes: 12 * 60, hoursFromUtc });
    for (const id of ["edit-sky", "edit-date", ...Object.values(NUMBERS)])
      byId(id).addEventListener("input", () => {
        this.tell();
        const daylight = daylightOf(this.choice);
        if (daylight) changed(daylight);
      });
  }

  /** Shows the controls, with what holds; undefined: with what they were. */
  show(isShown: boolean, daylight: Daylight | undefined): void {
    byId("edit-daylight").hidden = !isShown;
    if (isShown && daylight) this.set(choiceOf(daylight, this.choice));
  }

  private get choice(): DaylightChoice {
    const number = (id: string) => input(id).valueAsNumber;
    return {
      sky: select("edit-sky").value as SkyName,
      latitude: number(NUMBERS.latitude),
      longitude: number(NUMBERS.longitude),
      date: input("edit-date").value,
      minutes: number(NUMBERS.minutes),
      hoursFromUtc: number(NUMBERS.hoursFromUtc),
    };
  }

  private set(choice: DaylightChoice): void {
    select("edit-sky").value = choice.sky;
    input("edit-date").value = choice.date;
    for (const [name, id] of Object.entries(NUMBERS)) input(id).value = String(choice[name as keyof typeof NUMBERS]);
    this.tell();
  }

  private tell(): void {
    byId("edit-clock").textContent = clockOf(input(NUMBERS.minutes).valueAsNumber);
    byId("edit-sun").hidden = ["overcast", "dark"].includes(select("edit-sky").value);
  }
}
