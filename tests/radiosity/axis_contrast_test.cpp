#include "radiosity/estimate/axis_contrast.h"

#include <gtest/gtest.h>

#include <random>

namespace alvor {
namespace {

template <class Light>
Split best_split(int strata_along_u, Light&& light, double noise = 0) {
  const PatchShape patch = PatchShape::whole(0, 4, strata_along_u);
  AxisContrast contrast(patch);
  for (int o = 0; o < strata_per_patch; ++o) {
    const Uv at = patch.stratum_centre(o);
    contrast.add(o, light(at.u, at.v));
  }
  return contrast.best_split(noise);
}

TEST(AxisContrast, SlabsLieSideBySideWhereLightChanges) {
  for (const int along_u : {2, 4, 8}) {
    EXPECT_EQ(best_split(along_u, [](double u, double) { return u; }), Split::slabs_along_u) << along_u;
    EXPECT_EQ(best_split(along_u, [](double, double v) { return v * v; }), Split::slabs_along_v) << along_u;
    EXPECT_EQ(best_split(along_u, [](double u, double v) { return u + v; }), Split::quarters) << along_u;
    EXPECT_EQ(best_split(along_u, [](double, double) { return 3.0; }), Split::quarters) << along_u;
  }
}

TEST(AxisContrast, SlabsAreBetterFromFourTimesTheVarianceOn) {
  EXPECT_EQ(best_split(4, [](double u, double v) { return 1.9 * u + v; }), Split::quarters);
  EXPECT_EQ(best_split(4, [](double u, double v) { return 2.1 * u + v; }), Split::slabs_along_u);
}

TEST(AxisContrast, NoiseSeldomAsksForSlabs) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  int slabs = 0;
  for (int n = 0; n < 1000; ++n)
    slabs += best_split(
                 4, [&](double, double) { return normal(random); }, 1) != Split::quarters;
  EXPECT_LT(slabs, 50);
}

TEST(AxisContrast, SlabsLieAlongTheOutlineOfWhatHides) {
  const PatchShape patch = PatchShape::whole(0, 4);
  const auto hidden_where = [&](auto&& hides) {
    std::uint16_t hidden = 0;
    for (int o = 0; o < strata_per_patch; ++o) hidden = static_cast<std::uint16_t>(hidden | hides(patch.stratum_centre(o)) << o);
    return AxisContrast::along_outline(patch, hidden);
  };
  EXPECT_EQ(hidden_where([](Uv at) { return at.u < 0.3; }), Split::slabs_along_u);
  EXPECT_EQ(hidden_where([](Uv at) { return at.v > 0.6; }), Split::slabs_along_v);
  EXPECT_EQ(hidden_where([](Uv at) { return at.u < 0.6 && at.v < 0.6; }), Split::quarters);
  EXPECT_EQ(hidden_where([](Uv at) { return at.u + at.v < 0.9; }), Split::quarters);
}

TEST(AxisContrast, TrianglesHaveNoSlabs) {
  const PatchShape patch = PatchShape::whole(0, 3);
  AxisContrast contrast(patch);
  for (int o = 0; o < strata_per_patch; ++o) contrast.add(o, patch.stratum_centre(o).u);
  EXPECT_EQ(contrast.best_split(0), Split::quarters);
}

}  // namespace
}  // namespace alvor
