// Boxes with one unknown per face: the system of a box with exact form factors has six equations.

#include "radiosity/solve/solver.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

/// Returns the radiosity of each face, W/m2, solved without splits and with rows of exact form factors.
std::vector<double> radiosity_by_face(const Scene& scene) {
  const BaseMesh mesh(scene);
  SolutionLog log;
  solve(mesh, {.tolerance = 1e-6, .max_depth = 0, .form_factors = FormFactorMethod::analytic}, log, {});
  std::vector<double> radiosity;
  for (const LeafValue& leaf : log.leaves()) {
    const Material& material = mesh.material_of(leaf.patch.root_face());
    radiosity.push_back(material.emission.r + material.reflectance.r * leaf.irradiance.r);
  }
  return radiosity;
}

/// A box on a square floor that emits 1 W/m2, and the radiosity of its floor, ceiling and walls from the system of six equations,
/// solved in binary128.
struct KnownBox {
  double side, height, reflectance;
  std::array<double, 3> radiosity;
};
void PrintTo(const KnownBox& box, std::ostream* out) {
  *out << box.side << " x " << box.side << " x " << box.height << ", rho " << box.reflectance;
}

constexpr KnownBox known_boxes[] = {
    {1, 1, 0.2, {1.0096153859783, 0.048044544595447, 0.048085017356573}},
    {1, 1, 0.5, {1.0909090981077, 0.18174582610779, 0.18183626894613}},
    {1, 1, 0.9, {2.3728813748258, 1.5253105511245, 1.5254520185124}},
    {1, 1, 0.99, {17.362270472597, 16.527425127722, 16.52757609992}},
    {1, 1, 0.999, {167.36122689329, 166.52763311108, 166.52778499891}},
    {1, 10, 0.2, {1.0012317970364, 0.0018638087128121, 0.006172609856269}},
    {1, 10, 0.5, {1.0121594989926, 0.013738031706923, 0.024352561732511}},
    {1, 10, 0.9, {1.1936677688571, 0.19650554412592, 0.21524566717543}},
    {1, 10, 0.99, {3.3345483655222, 2.3376690327427, 2.3581945650434}},
    {1, 10, 0.999, {24.762922954158, 23.766071901746, 23.786775128602}},
    {1, 100, 0.2, {1.0001248688092, 0.00013123454202489, 0.00062435974162193}},
    {1, 100, 0.5, {1.0012468434086, 0.0012627575886899, 0.0024937259975068}},
    {1, 100, 0.9, {1.0201591560006, 0.020187801160123, 0.022399132607098}},
    {1, 100, 0.99, {1.2438179465642, 0.24384945614942, 0.24628083149322}},
    {1, 100, 0.999, {3.482601746854, 2.4826335428809, 2.4850869117757}},
    {10, 1, 0.2, {1.0325752145807, 0.17449992709224, 0.10731214581754}},
    {10, 1, 0.5, {1.2688440935871, 0.56137898031762, 0.42444231523816}},
    {10, 1, 0.9, {4.5338906913798, 3.9605931930903, 3.7637902888247}},
    {10, 1, 0.99, {42.021894076622, 41.472058212219, 41.265119277897}},
    {10, 1, 0.999, {417.02074710426, 416.47315221785, 416.26525169472}},
    {1, 0.01, 0.2, {1.0405825429225, 0.20452038672527, 0.12242675880599}},
    {1, 0.01, 0.5, {1.3257257574847, 0.65467863003394, 0.48989031203401}},
    {1, 0.01, 0.9, {5.1773976143068, 4.6461538236298, 4.4112140515847}},
    {1, 0.01, 0.99, {49.283152107605, 48.775695653318, 48.528805976928}},
    {1, 0.01, 0.999, {490.45849175966, 489.9532973983, 489.70527105113}},
};

class BoxOfOneUnknownPerFace : public testing::TestWithParam<KnownBox> {};
/// "Side1Height10Reflectance999PerMille".
std::string name_of(const testing::TestParamInfo<KnownBox>& box) {
  const auto digits = [](double number) {
    return number < 1 ? "1_" + std::to_string(std::lround(1 / number)) : std::to_string(std::lround(number));
  };
  return "Side" + digits(box.param.side) + "Height" + digits(box.param.height) + "Reflectance" +
         std::to_string(std::lround(1000 * box.param.reflectance)) + "PerMille";
}
INSTANTIATE_TEST_SUITE_P(Boxes, BoxOfOneUnknownPerFace, testing::ValuesIn(known_boxes), name_of);

// All faces emit 1 more, so that rows carry the emission. That part alone makes the radiosity 1 / (1 - rho) everywhere.
TEST_P(BoxOfOneUnknownPerFace, HasTheKnownRadiosity) {
  const auto& [side, height, reflectance, radiosity] = GetParam();
  Scene scene;
  scene.materials = {test::grey(1, reflectance), test::grey(2, reflectance)};
  test::add_box(scene, {0, 0, 0}, {side, height, side}, true, {1, 0, 0, 0, 0, 0});
  // Rounding of a row's sum to float32 adds up over reflections, so the tolerance grows with 1 / (1 - rho).
  const double furnace = 1 / (1 - reflectance), rounding = std::max(1e-6, 1e-7 * furnace);
  const std::vector<double> found = radiosity_by_face(scene);
  ASSERT_EQ(found.size(), 6u);
  for (std::size_t face = 0; face < 6; ++face) {
    const double expected = furnace + radiosity[std::min<std::size_t>(face, 2)];
    EXPECT_NEAR(found[face], expected, rounding * expected) << "face " << face;
  }
}

// All light of the inner cube goes to the outer one; the share of the outer cube's light that goes to the inner one is the ratio
// of their areas. So the emission that makes a chosen radiosity is known, and the solution must be that radiosity.
TEST(ConcentricCubes, HaveTheRadiosityTheirEmissionWasMadeFor) {
  constexpr double inner_side = 0.5, outer = 3, inner = 2, outer_reflectance = 0.8, inner_reflectance = 0.3;
  constexpr double to_inner = inner_side * inner_side, low = (1 - inner_side) / 2, high = (1 + inner_side) / 2;
  Scene scene;
  scene.materials = {test::grey(outer - outer_reflectance * (to_inner * inner + (1 - to_inner) * outer), outer_reflectance),
                     test::grey(inner - inner_reflectance * outer, inner_reflectance)};
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, true);
  test::add_box(scene, {low, low, low}, {high, high, high}, false, {1, 1, 1, 1, 1, 1});
  const std::vector<double> found = radiosity_by_face(scene);
  ASSERT_EQ(found.size(), 12u);
  for (std::size_t face = 0; face < 12; ++face) EXPECT_NEAR(found[face], face < 6 ? outer : inner, 1e-4) << "face " << face;
}

}  // namespace
}  // namespace alvor
