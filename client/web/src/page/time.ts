import type { Duration } from "@bufbuild/protobuf/wkt";

export function secondsOf(duration?: Duration): number {
  return duration ? Number(duration.seconds) + 1e-9 * duration.nanos : 0;
}
