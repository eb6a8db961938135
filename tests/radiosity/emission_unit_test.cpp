#include "radiosity/direct/emission_unit.h"

#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <concepts>
#include <type_traits>

namespace alvor {
namespace {

template <class A, class B>
concept Adds = requires(A a, B b) {
  a + b;
}
|| requires(A a, B b) { a - b; }
|| requires(A a, B b) { a += b; };
template <class A, class B>
concept Multiplies = requires(A a, B b) {
  a* b;
};

// Checkpoints hold the bytes of both.
static_assert(sizeof(RelativeLight) == sizeof(Rgb) && std::is_trivially_copyable_v<RelativeLight>);

TEST(RelativeLight, IsNotWattsPerSquareMetre) {
  EXPECT_FALSE((std::convertible_to<Rgb, RelativeLight> || std::is_constructible_v<RelativeLight, Rgb>));
  EXPECT_FALSE((std::convertible_to<RelativeLight, Rgb> || std::is_constructible_v<Rgb, RelativeLight>));
  EXPECT_FALSE((Adds<Rgb, RelativeLight> || Adds<RelativeLight, Rgb>));
  EXPECT_FALSE((std::equality_comparable_with<Rgb, RelativeLight>));
}

TEST(RelativeLight, TimesAFactorIsRelativeLight) {
  EXPECT_TRUE((std::same_as<decltype(Rgb{} * RelativeLight{}), RelativeLight>));
  EXPECT_TRUE((std::same_as<decltype(2.0 * RelativeLight{}), RelativeLight>));
  EXPECT_TRUE((std::same_as<decltype(RelativeLight{} / RelativeLight{}), Rgb>));
  EXPECT_FALSE((Multiplies<RelativeLight, RelativeLight>));
  EXPECT_EQ((Rgb{0.5, 0.25, 0} * RelativeLight{2, 4, 8}), (RelativeLight{1, 1, 0}));
}

TEST(EmissionUnit, IsTheBrightestBandThatAnySurfaceEmits) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(8, 0.5)};
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, true);
  scene.materials[0].emission = {2, 32, 0};
  const EmissionUnit unit{BaseMesh(scene)};
  EXPECT_EQ(unit.from_watts_per_m2({2, 32, 0}), (RelativeLight{0.0625, 1, 0}));
  EXPECT_EQ(unit.to_watts_per_m2({0.0625, 1, 0}), (Rgb{2, 32, 0}));
  EXPECT_EQ(unit.to_watts(2), 64);
}

}  // namespace
}  // namespace alvor
