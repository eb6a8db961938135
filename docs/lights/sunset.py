"""Writes FILE.hdr for docs/lights.md: surroundings with a low sun, an orange horizon, a blue sky and a brown ground.

Run: python3 docs/lights/sunset.py sunset.hdr
"""

import math
import sys

WIDTH, HEIGHT = 512, 256
SUN_AZIMUTH, SUN_ELEVATION, SUN_RADIUS = math.radians(120), math.radians(14), math.radians(1.2)


def radiance(azimuth, elevation):
    """Returns r, g, b, cd/m2."""
    if elevation < 0:
        return 260, 200, 150
    cosine = (math.sin(elevation) * math.sin(SUN_ELEVATION)
              + math.cos(elevation) * math.cos(SUN_ELEVATION) * math.cos(azimuth - SUN_AZIMUTH))
    if math.acos(min(1, cosine)) < SUN_RADIUS:
        return 2.2e7, 1.3e7, 5e6
    glow = math.exp(-3 * elevation) * (0.3 + 0.7 * math.exp(3 * (cosine - 1)))
    return 700 + 6000 * glow, 1100 + 2600 * glow, 2300 + 900 * glow


def rgbe(values):
    brightest = max(values)
    fraction, exponent = math.frexp(brightest)
    scale = fraction * 256 / brightest
    return bytes([int(value * scale) for value in values] + [exponent + 128])


with open(sys.argv[1], "wb") as file:
    file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (HEIGHT, WIDTH))
    for row in range(HEIGHT):
        for column in range(WIDTH):
            file.write(rgbe(radiance(2 * math.pi * ((column + 0.5) / WIDTH - 0.5), math.pi * (0.5 - (row + 0.5) / HEIGHT))))
