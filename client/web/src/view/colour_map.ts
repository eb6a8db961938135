// Equal steps in lightness too: after viridis (van der Walt and Smith 2015), as client/colour_map.cpp.

const ANCHORS = [
  [68, 1, 84], [72, 36, 117], [65, 68, 135], [53, 95, 141], [42, 120, 142], [33, 145, 140],
  [34, 168, 132], [68, 191, 112], [122, 209, 81], [189, 223, 38], [253, 231, 37],
];

/** Bytes of sRGB at a position from 0 to 1. */
export function colourMap(position: number): [number, number, number] {
  const place = Math.min(1, Math.max(0, position)) * (ANCHORS.length - 1);
  const below = Math.min(Math.floor(place), ANCHORS.length - 2);
  const share = place - below;
  return [0, 1, 2].map((band) => Math.round((1 - share) * ANCHORS[below][band] + share * ANCHORS[below + 1][band])) as [
    number,
    number,
    number,
  ];
}
