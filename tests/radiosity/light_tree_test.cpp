#include "radiosity/direct/light_tree.h"

#include "radiosity/direct/direct_light.h"
#include "radiosity/direct/emission_unit.h"
#include "radiosity/direct/face_light.h"
#include "radiosity/form_factors/form_factor.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>

namespace alvor {
namespace {

/// A receiving point and its normal, in local units.
struct Place {
  Vec3 at, normal;
};

class Random {
 public:
  explicit Random(unsigned seed) : random_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * std::uniform_real_distribution<double>()(random_); }
  Vec3 point(Vec3 low, Vec3 high) { return {uniform(low.x, high.x), uniform(low.y, high.y), uniform(low.z, high.z)}; }
  Vec3 direction() { return normalized(Vec3{normal_(random_), normal_(random_), normal_(random_)}); }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

constexpr Vec3 room{4, 3, 5};

void add_lamp(Scene& scene, Vec3 centre, Vec3 s, Vec3 t) {
  test::add_polygon(scene, {centre - s - t, centre + s - t, centre + s + t, centre - s + t}, 1);
}

/// Returns a closed room with 200 small lamps of random place and direction, and two blocks.
Scene room_of_lamps() {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(100, 0)};
  test::add_box(scene, {0, 0, 0}, room, true);
  Random random(1);
  for (int n = 0; n < 200; ++n) {
    const Vec3 s = random.direction(), t = normalized(cross(s, random.direction()));
    const double half_edge = random.uniform(0.02, 0.05);
    add_lamp(scene, random.point({0.2, 1, 0.2}, {3.8, 2.8, 4.8}), half_edge * s, half_edge * t);
  }
  test::add_box(scene, {1, 0, 1}, {2, 1, 3}, false);
  test::add_box(scene, {2.5, 1, 3}, {3.5, 1.5, 4}, false);
  return scene;
}

/// A scene of lamps with its light tree.
struct Lamps {
  BaseMesh mesh;
  LocalScene scene{mesh};
  std::vector<std::unique_ptr<FaceLight>> faces = faces_of(scene);
  std::vector<const LightSource*> lights = borrowed(faces);
  LightTree tree{lights};

  explicit Lamps(const Scene& from) : mesh(from) {}

  static std::vector<std::unique_ptr<FaceLight>> faces_of(const LocalScene& scene) {
    std::vector<std::unique_ptr<FaceLight>> faces;
    const EmissionUnit unit(scene.mesh());
    for (std::uint32_t root = 0; root < scene.mesh().roots().size(); ++root)
      if (const Rgb emission = scene.mesh().material_of(root).emission; !emission.is_zero())
        faces.push_back(std::make_unique<FaceLight>(scene, root, unit.from_watts_per_m2(emission)));
    return faces;
  }
  static std::vector<const LightSource*> borrowed(const std::vector<std::unique_ptr<FaceLight>>& faces) {
    std::vector<const LightSource*> lights;
    for (const auto& face : faces) lights.push_back(face.get());
    return lights;
  }
  /// Returns the unoccluded irradiance that the emitter brings to the place, summed over bands.
  double brings(std::uint32_t emitter, const Place& place) const {
    const std::uint32_t root = faces[emitter]->root();
    const auto corners = scene.corners(root);
    if (dot(place.at - corners[0], mesh.roots()[root].normal) <= 0) return 0;
    return lights[emitter]->colour().sum() * point_to_polygon(place.at, place.normal, corners);
  }
  double rest_brings(const LightChoice& choice, const Place& place) const {
    const std::set single(choice.single.begin(), choice.single.end());
    double sum = 0;
    for (std::uint32_t e = 0; e < lights.size(); ++e)
      if (!single.contains(e)) sum += brings(e, place);
    return sum;
  }
  Place random_place(Random& random) const { return {scene.frame().to_local(random.point({}, room)), random.direction()}; }
};

TEST(LightTree, NoEmitterIsBothSingleAndInTheRest) {
  const Lamps lamps(room_of_lamps());
  Random random(2);
  RandomStream draws(1, PatchId::root(0));
  for (int n = 0; n < 20; ++n) {
    const Place place = lamps.random_place(random);
    const LightChoice choice = lamps.tree.choose(place.at, 0, place.normal);
    const std::set single(choice.single.begin(), choice.single.end());
    EXPECT_EQ(single.size(), choice.single.size());
    for (int d = 0; d < 500 && choice.rest_bound > 0; ++d) {
      const auto drawn = lamps.tree.draw(choice, place.at, 0, place.normal, draws);
      EXPECT_FALSE(drawn.probability > 0 && single.contains(drawn.light));
    }
  }
}

TEST(LightTree, DrawsOverTheirProbabilityAddUpToAllThatTheRestBrings) {
  // If so, each emitter of the rest that brings light is drawn from one cluster only, with the probability that draw() returns.
  const Lamps lamps(room_of_lamps());
  Random random(3);
  RandomStream draws(2, PatchId::root(0));
  double deviations = 0;
  constexpr int places = 20, count = 5000;
  for (int n = 0; n < places; ++n) {
    const Place place = lamps.random_place(random);
    const LightChoice choice = lamps.tree.choose(place.at, 0, place.normal);
    if (choice.rest_bound == 0) continue;
    double sum = 0, squares = 0;
    for (int d = 0; d < count; ++d) {
      const auto drawn = lamps.tree.draw(choice, place.at, 0, place.normal, draws);
      const double brought = drawn.probability > 0 ? lamps.brings(drawn.light, place) / drawn.probability : 0;
      sum += brought / count;
      squares += brought * brought / count;
    }
    deviations += (sum - lamps.rest_brings(choice, place)) / std::sqrt((squares - sum * sum) / count) / std::sqrt(places);
  }
  EXPECT_LT(std::abs(deviations), 3);  // in standard errors, of all places together
}

TEST(LightTree, AnEmitterIsDrawnAsOftenAsItsProbabilitySays) {
  const Lamps lamps(room_of_lamps());
  const Place floor{lamps.scene.frame().to_local({2.2, 0, 2.5}), {0, 1, 0}};
  const LightChoice choice = lamps.tree.choose(floor.at, 0, floor.normal);
  RandomStream draws(3, PatchId::root(0));
  std::map<std::uint32_t, std::pair<double, int>> seen;  // probability and count, by emitter
  double nothing = 0;                                    // share of the draws that ended where no bound was left
  constexpr int count = 20'000;
  for (int d = 0; d < count; ++d) {
    const auto drawn = lamps.tree.draw(choice, floor.at, 0, floor.normal, draws);
    if (drawn.probability == 0) {
      nothing += 1.0 / count;
      continue;
    }
    auto& [probability, times] = seen.try_emplace(drawn.light, drawn.probability, 0).first->second;
    EXPECT_EQ(probability, drawn.probability) << "an emitter has one place in the tree";
    ++times;
  }
  double sum = 0;
  for (const auto& [emitter, drawn] : seen) {
    sum += drawn.first;
    const double expected = count * drawn.first;
    // None of about 150 emitters may deviate by more than 4.5 standard deviations.
    EXPECT_NEAR(drawn.second, expected, 4.5 * std::sqrt(expected) + 4) << "emitter " << emitter;
  }
  // Emitters that were never drawn have less than 1e-3 of all the probability; the share of nothing has a standard error of 2e-3.
  EXPECT_NEAR(sum + nothing, 1, 0.01);
}

TEST(LightTree, RestNeverBringsMoreThanItsBound) {
  const Lamps lamps(room_of_lamps());
  Random random(4);
  for (int n = 0; n < 1000; ++n) {
    const double radius = n % 2 == 0 ? 0 : 0.03;
    Place place = lamps.random_place(random);
    const LightChoice choice = lamps.tree.choose(place.at, radius, place.normal);
    place.at += radius * random.direction();  // any point of the sphere
    EXPECT_LE(lamps.rest_brings(choice, place), choice.rest_bound);
  }
}

TEST(LightTree, EmittersBehindOrFacingAwayAreNeverChosen) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(100, 0)};
  const Vec3 x{0.1, 0, 0}, z{0, 0, 0.1};
  // Four times three lamps: one above the point that faces down, one above that faces up, and one below that faces up.
  for (int n = 0; n < 12; ++n) {
    const Vec3 at{0.5 * n, n % 3 == 2 ? -1.0 : 1.0, 0.3 * (n % 4)};
    if (n % 3 == 0) add_lamp(scene, at, x, z);
    else add_lamp(scene, at, z, x);
  }
  const Lamps lamps(scene);
  ASSERT_LT(lamps.mesh.roots()[0].normal.y, 0);
  const Vec3 at = lamps.scene.frame().to_local({3, 0, 0.5});
  const LightChoice choice = lamps.tree.choose(at, 1e-3, {0, 1, 0});
  std::set<std::uint32_t> chosen(choice.single.begin(), choice.single.end());
  RandomStream draws(4, PatchId::root(0));
  for (int d = 0; d < 1000 && choice.rest_bound > 0; ++d)
    if (const auto drawn = lamps.tree.draw(choice, at, 1e-3, {0, 1, 0}, draws); drawn.probability > 0) chosen.insert(drawn.light);
  EXPECT_EQ(chosen, (std::set<std::uint32_t>{0, 3, 6, 9}));
}

TEST(LightTree, OfNoEmittersNothingIsChosen) {
  const Lamps dark(test::furnace(0, 0.5));
  const LightChoice choice = dark.tree.choose({}, 0.1, {0, 1, 0});
  EXPECT_TRUE(choice.single.empty());
  EXPECT_EQ(choice.rest_bound, 0);
}

/// Returns the sixteen patches of level 2 of the floor.
std::vector<Receiver> floor_patches(const BaseMesh& mesh) {
  std::vector<Receiver> receivers;
  for (int k = 0; k < 16; ++k) {
    const PatchId patch = PatchId::root(0).child(k / 4).child(k % 4);
    receivers.push_back({patch, shape_of(mesh, patch)});
  }
  return receivers;
}

double mean_irradiance(std::span<const DirectLight> light) {
  double sum = 0;
  for (const DirectLight& patch : light) sum += patch.irradiance.mean() / double(light.size());
  return sum;
}

TEST(LightTree, ManyLightsByTheTreeAreAsBrightAsOneByOneForATenthOfTheRays) {
  const Lamps lamps(room_of_lamps());
  const auto receivers = floor_patches(lamps.mesh);
  RayBudget all([] { return false; }), few([] { return false; });
  double difference = 0, squares = 0, brightness = 0;
  constexpr int seeds = 64;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    std::vector<DirectLight> one_by_one(receivers.size()), by_tree(receivers.size());
    add_direct_light(lamps.scene, lamps.lights, receivers, seed, all, one_by_one);
    add_direct_light(lamps.scene, lamps.tree, receivers, seed, few, by_tree);
    const double more = mean_irradiance(by_tree) - mean_irradiance(one_by_one);
    difference += more / seeds;
    squares += more * more / seeds;
    brightness += mean_irradiance(one_by_one) / seeds;
  }
  const double standard_error = std::sqrt((squares - difference * difference) / seeds);
  EXPECT_LT(standard_error, 0.01 * brightness) << "or the next line says nothing";
  EXPECT_NEAR(difference, 0, 3 * standard_error);
  EXPECT_LT(10 * few.rays(), all.rays());
}

}  // namespace
}  // namespace alvor
