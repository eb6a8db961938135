#pragma once
// Scenes of few faces whose light is known.

#include "tests/scenes.h"

#include <array>

namespace alvor::bench {

using test::grey;

void add_quad(Scene& scene, Vec3 a, Vec3 b, Vec3 c, Vec3 d, std::uint32_t material = 0);

/// The materials of a box's six quads: y low, y high, x low, x high, z low, z high.
using BoxMaterials = std::array<std::uint32_t, 6>;
/// Adds a box whose quads face inwards.
void add_room(Scene& scene, Vec3 low, Vec3 high, const BoxMaterials& materials = {});
/// Adds a box whose quads face outwards.
void add_block(Scene& scene, Vec3 low, Vec3 high, const BoxMaterials& materials = {});

/// Returns a closed room of unit size. Its floor has the material `floor`, all else `rest`.
Scene unit_cube(const Material& floor, const Material& rest);

/// Returns two unit squares that face each other; the first, below, emits.
Scene facing_plates(double distance, double reflectance);

/// Returns unit cubes in a row along x, joined by doors of 0.2 x 0.4 m. The ceiling of the first one emits 1 W/m2.
Scene chain_of_rooms(int count, double reflectance);

/// Returns the scene with each vertex p replaced by scale p + offset.
Scene placed(Scene scene, double scale, Vec3 offset = {});

}  // namespace alvor::bench
