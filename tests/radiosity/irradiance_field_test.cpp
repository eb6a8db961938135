#include "radiosity/exchange/irradiance_field.h"

#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace alvor {
namespace {

constexpr double rays = 64;                 // rays of each quarter of a row
constexpr double size = 16;                 // edge of a floor of 16 x 16 rows, m; a row's edge is 1 m
constexpr double narrow = 1.5, wide = 3.5;  // radii of the windows, in edges of a row

/// The rows of a scene, all of one level of the quadtree.
struct Rows {
  BaseMesh mesh;
  PatchForest forest{mesh};
  std::vector<NodeIndex> nodes;
  std::vector<SmoothNeighbours> neighbours;
  std::vector<Vec3> centre_of_node;

  Rows(const Scene& scene, int level, bool has_slabs = false) : mesh(scene) {
    std::vector<NodeIndex> split;
    for (int n = 0; n < level; ++n)
      for (const NodeIndex leaf : forest.leaves()) forest.split(leaf, {}, split);
    if (has_slabs)
      for (const NodeIndex leaf : forest.leaves())
        if (forest.id(leaf).child_index(1) != 0) forest.split(leaf, {}, split, Split::slabs_along_v);
    nodes = forest.leaves();
    for (const NodeIndex node : nodes) neighbours.emplace_back(forest, node);
    for (NodeIndex node = 0; node < forest.node_count(); ++node) centre_of_node.push_back(centre_of(mesh, forest.shape(node)));
  }

  std::size_t size() const { return nodes.size(); }
  Vec3 centre(std::size_t n) const { return centre_of_node[nodes[n]]; }
  Vec3 quarter(std::size_t n, int k) const { return centre_of(mesh, forest.shape(nodes[n]).child(k)); }

  /// Returns samples whose irradiance is irradiance(centre of the quarter) in all bands.
  template <class Irradiance>
  std::vector<RowSamples> samples(Irradiance&& irradiance) const {
    std::vector<RowSamples> samples(size());
    for (std::size_t n = 0; n < size(); ++n)
      for (int k = 0; k < 4; ++k) samples[n][k] = {irradiance(quarter(n, k)) * RelativeLight{1, 1, 1}, rays};
    return samples;
  }
  std::vector<FieldFit> fit(std::span<const RowSamples> samples) const {
    std::vector<FieldFit> all;
    const auto take = [&](std::span<const std::uint32_t>, std::span<const FieldFit> fits) {
      all.insert(all.end(), fits.begin(), fits.end());
    };
    std::vector<std::uint32_t> wanted(nodes.size());
    std::iota(wanted.begin(), wanted.end(), 0);
    fit_field(forest, nodes, neighbours, samples, centre_of_node, wanted, take);
    return all;
  }
};

/// Fits of some rows, from samples of those around them alone.
std::vector<FieldFit> fit_some(const Rows& rows, std::span<const RowSamples> samples, std::span<const std::uint32_t> given,
                               std::span<const std::uint32_t> wanted) {
  std::vector<NodeIndex> nodes;
  std::vector<SmoothNeighbours> neighbours;
  std::vector<RowSamples> of_given;
  for (const std::uint32_t n : given)
    nodes.push_back(rows.nodes[n]), neighbours.push_back(rows.neighbours[n]), of_given.push_back(samples[n]);
  std::vector<FieldFit> fits(rows.size());
  const auto take = [&](std::span<const std::uint32_t> places, std::span<const FieldFit> found) {
    for (std::size_t k = 0; k < places.size(); ++k) fits[given[places[k]]] = found[k];
  };
  fit_field(rows.forest, nodes, neighbours, of_given, rows.centre_of_node, wanted, take);
  return fits;
}

Rows floor_rows(int level = 4, bool has_slabs = false) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5)};
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, size}, {size, 0, size}, {size, 0, 0}});
  return {scene, level, has_slabs};
}

/// Returns whether no wide window about the point reaches the floor's edge.
bool is_inner(Vec3 p) { return std::min(std::min(p.x, size - p.x), std::min(p.z, size - p.z)) > wide; }

template <class Irradiance>
double worst_error_at_centres(const Rows& rows, std::span<const FieldFit> fits, Irradiance&& irradiance) {
  double worst = 0;
  for (std::size_t n = 0; n < rows.size(); ++n)
    worst = std::max(worst, std::abs(fits[n].at(rows.centre(n)).g - irradiance(rows.centre(n))));
  return worst;
}

template <class Irradiance>
double worst_error_at_quarters(const Rows& rows, std::span<const FieldFit> fits, Irradiance&& irradiance) {
  double worst = 0;
  for (std::size_t n = 0; n < rows.size(); ++n)
    for (int k = 0; k < 4; ++k)
      worst = std::max(worst, std::abs(fits[n].at(rows.quarter(n, k)).g - irradiance(rows.quarter(n, k))));
  return worst;
}

/// Independent noise of variance 1.
class Noise {
 public:
  explicit Noise(unsigned seed) : random_(seed) {}
  double operator()() { return normal_(random_); }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

TEST(IrradianceField, ConstantAndLinearIrradianceIsReproducedUpToTheEdges) {
  const Rows rows = floor_rows();
  const auto constant = [](Vec3) { return 7.0; };
  const auto linear = [](Vec3 p) { return 7 + p.x + 2 * p.z; };
  EXPECT_LT(worst_error_at_centres(rows, rows.fit(rows.samples(constant)), constant), 1e-11);
  EXPECT_LT(worst_error_at_quarters(rows, rows.fit(rows.samples(constant)), constant), 1e-11);
  EXPECT_LT(worst_error_at_centres(rows, rows.fit(rows.samples(linear)), linear), 1e-11);
  EXPECT_LT(worst_error_at_quarters(rows, rows.fit(rows.samples(linear)), linear), 1e-11);
}

TEST(IrradianceField, LinearIrradianceIsReproducedOnSlabsAndBesideThem) {
  const Rows rows = floor_rows(3, true);
  const auto linear = [](Vec3 p) { return 7 + p.x + 2 * p.z; };
  EXPECT_LT(worst_error_at_centres(rows, rows.fit(rows.samples(linear)), linear), 1e-11);
  EXPECT_LT(worst_error_at_quarters(rows, rows.fit(rows.samples(linear)), linear), 1e-11);
}

TEST(IrradianceField, QuadraticIrradianceIsReproducedWhereMeansOverRowsAreItsValues) {
  // Far rows count as a whole. The mean of a row's four quarters is the value at its centre if the sum of second derivatives is
  // 0.
  const Rows rows = floor_rows();
  const auto saddle = [](Vec3 p) { return 200 + p.x + 2 * p.z + p.x * p.z + 0.5 * (p.x * p.x - p.z * p.z); };
  const auto fits = rows.fit(rows.samples(saddle));
  EXPECT_LT(worst_error_at_centres(rows, fits, saddle), 1e-9);
  EXPECT_LT(worst_error_at_quarters(rows, fits, saddle), 1e-9);
}

TEST(IrradianceField, PlaneTakenForAParabolaErrsByItsMeanOverTheNarrowWindow) {
  // The samples have no noise that could explain a misfit of the wide window. The mean of x^2 over a disk of radius R, weighted
  // by (1 - r^2 / R^2)^2, is R^2 / 8. Rows at the floor's edge have half a disk.
  const Rows rows = floor_rows();
  const auto parabola = [](Vec3 p) { return 200 + p.x * p.x; };
  EXPECT_LT(worst_error_at_centres(rows, rows.fit(rows.samples(parabola)), parabola), 1.2 * narrow * narrow / 8);
}

/// Mean squares over the inner rows of a field with noise, over ten draws of the noise.
struct NoiseFigures {
  double own_mean = 0, fit = 0;  ///< squared errors of the row's own mean and of its fit
  double variance = 0;           ///< the fit's own estimate of the second
  double misfit = 0, squared_misfits = 0, count = 0;

  template <class Irradiance>
  NoiseFigures(const Rows& rows, Irradiance&& irradiance) {
    for (unsigned seed = 0; seed < 40; ++seed) {
      Noise noise(seed);
      const auto samples = rows.samples([&](Vec3 p) { return irradiance(p) + noise(); });
      const auto fits = rows.fit(samples);
      for (std::size_t n = 0; n < rows.size(); ++n)
        if (is_inner(rows.centre(n))) add(samples[n], fits[n], rows.centre(n), irradiance(rows.centre(n)));
    }
    for (double* sum : {&own_mean, &fit, &variance, &misfit, &squared_misfits}) *sum /= count;
  }
  /// Standard error of the mean misfit, if rows were independent; those whose windows overlap are not.
  double misfit_error() const { return std::sqrt((squared_misfits - misfit * misfit) / count); }

 private:
  void add(const RowSamples& row, const FieldFit& fitted, Vec3 centre, double truth) {
    const double own = (row[0].irradiance.g + row[1].irradiance.g + row[2].irradiance.g + row[3].irradiance.g) / 4;
    own_mean += std::pow(own - truth, 2);
    fit += std::pow(fitted.at(centre).g - truth, 2);
    variance += fitted.variance;
    misfit += fitted.squared_misfit;
    squared_misfits += std::pow(fitted.squared_misfit, 2);
    count += 1;
  }
};

std::vector<NoiseFigures> flat_sloping_and_curved_under_noise() {
  const Rows rows = floor_rows();
  return {NoiseFigures(rows, [](Vec3) { return 100; }), NoiseFigures(rows, [](Vec3 p) { return 100 + p.x - 2 * p.z; }),
          NoiseFigures(rows, [](Vec3 p) { return 100 + 0.05 * p.x * p.x; })};
}

TEST(IrradianceField, NoiseIsReducedAndKnown) {
  for (const NoiseFigures& figures : flat_sloping_and_curved_under_noise()) {
    EXPECT_NEAR(figures.own_mean, 0.25, 0.03);  // variance of a mean of four samples, over some 600 rows
    EXPECT_LT(std::sqrt(figures.fit), 0.5 * std::sqrt(figures.own_mean));
    EXPECT_LT(std::sqrt(figures.fit), 2 * std::sqrt(figures.variance));
    EXPECT_GT(std::sqrt(figures.fit), 0.5 * std::sqrt(figures.variance));
  }
}

TEST(IrradianceField, NoiseIsNoMisfit) {
  // The variance of a sample is 1. A fit that knows the row's samples leaves 0.8 of it in a narrow window and 0.95 in a wide one;
  // 0.8 is taken off.
  for (const NoiseFigures& figures : flat_sloping_and_curved_under_noise()) {
    const double by_chance = 6 * figures.misfit_error();
    EXPECT_LT(by_chance, 0.1) << "too few rows to tell";
    EXPECT_GE(figures.misfit, 0 - by_chance);
    EXPECT_LE(figures.misfit, 0.15 + by_chance);
  }
}

/// Expects that a step of a hundred noise levels across `normal . p = at` does not change fits further from it than `reach`
/// edges.
void expect_no_leak(Vec3 normal, double at, double reach) {
  const Rows rows = floor_rows();
  const auto step = [&](Vec3 p) { return dot(p, normal) < at ? 100.0 : 200.0; };
  Noise noise(3);
  const auto fits = rows.fit(rows.samples([&](Vec3 p) { return step(p) + noise(); }));
  double at_step = 0;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const double distance = std::abs(dot(rows.centre(n), normal) - at);
    if (distance < 0.5) at_step = std::max(at_step, fits[n].squared_misfit);
    if (distance < reach) continue;
    // The tolerance 2 is four standard deviations of a row's own mean. Each of its samples misses by 1, rarely by 3.
    EXPECT_NEAR(fits[n].at(rows.centre(n)).g, step(rows.centre(n)), 2) << "at " << distance;
    EXPECT_LT(fits[n].squared_misfit, 6) << "at " << distance;
  }
  EXPECT_GT(at_step, 100);
}

TEST(IrradianceField, StepDoesNotLeakBeyondTheNarrowWindow) {
  for (const double at : {8.25, 8.5, 8.75}) expect_no_leak({1, 0, 0}, at, narrow);
}

TEST(IrradianceField, SlantingStepThatLooksLikeNoiseDoesNotLeakBeyondTheWideWindow) {
  expect_no_leak(normalized({1, 0, 1}), 16.3 / std::sqrt(2), wide + 0.5);
}

TEST(IrradianceField, HiddenQuartersAreIgnored) {
  const Rows rows = floor_rows();
  const auto linear = [](Vec3 p) { return 50 + p.x + 2 * p.z; };
  auto samples = rows.samples(linear);
  for (std::size_t n = 0; n < rows.size(); n += 3) samples[n][n % 4] = {{1e6, 0, 1e9}, 0};
  const auto fits = rows.fit(samples);
  EXPECT_LT(worst_error_at_centres(rows, fits, linear), 1e-10);
  for (const FieldFit& fit : fits) EXPECT_LT(fit.squared_misfit, 1e-20);
}

TEST(IrradianceField, HiddenRowsAreDarkAndIgnored) {
  const Rows rows = floor_rows();
  const auto linear = [](Vec3 p) { return 50 + p.x + 2 * p.z; };
  auto samples = rows.samples(linear);
  for (std::size_t n = 0; n < rows.size(); n += 7) samples[n].fill({{1e6, 0, 1e9}, 0});
  const auto fits = rows.fit(samples);
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const double expected = n % 7 == 0 ? 0 : linear(rows.centre(n));
    EXPECT_NEAR(fits[n].at(rows.centre(n)).g, expected, 1e-10);
  }
}

TEST(IrradianceField, DarkRowsAreExactlyDarkAndDoNotDarkenTheirNeighbours) {
  const Rows rows = floor_rows();
  const auto half = [](Vec3 p) { return p.x < size / 2 ? 0.0 : 30 + p.z; };
  const auto fits = rows.fit(rows.samples(half));
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const Vec3 at = rows.centre(n);
    if (at.x < size / 2) EXPECT_EQ(fits[n].at(at), RelativeLight{});
    else EXPECT_NEAR(fits[n].at(at).g, half(at), 1e-11);
  }
}

TEST(IrradianceField, CreasesAreNotCrossed) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5)};
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, 4}, {4, 0, 4}, {4, 0, 0}});
  test::add_polygon(scene, {{0, 0, 0}, {0, 4, 0}, {0, 4, 4}, {0, 0, 4}});  // a wall along one edge of the floor
  const Rows rows(scene, 3);
  const auto floor_beside_wall_of = [&](double wall) {
    Noise noise(4);
    return rows.fit(rows.samples([&](Vec3 p) { return p.y > 0 ? wall : 10 + p.x + noise(); }));
  };
  const auto dim = floor_beside_wall_of(5), bright = floor_beside_wall_of(5000);
  for (std::size_t n = 0; n < rows.size(); ++n) {
    if (rows.centre(n).y > 0) continue;
    EXPECT_EQ(dim[n].coefficient, bright[n].coefficient);
    EXPECT_EQ(dim[n].variance, bright[n].variance);
  }
}

TEST(IrradianceField, BandsAreFittedApart) {
  const Rows rows = floor_rows();
  auto samples = rows.samples([](Vec3 p) { return 50 + p.x; });
  for (std::size_t n = 0; n < rows.size(); ++n)
    for (int k = 0; k < 4; ++k) samples[n][k].irradiance = {50 + rows.quarter(n, k).x, 0, 80 - rows.quarter(n, k).z};
  const auto fits = rows.fit(samples);
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const RelativeLight value = fits[n].at(rows.centre(n));
    EXPECT_NEAR(value.r, 50 + rows.centre(n).x, 1e-10);
    EXPECT_EQ(value.g, 0);
    EXPECT_NEAR(value.b, 80 - rows.centre(n).z, 1e-10);
  }
}

TEST(IrradianceField, FitsOfSomeRowsAreThoseOfAllRows) {
  const Rows rows = floor_rows();
  const auto samples = rows.samples([](Vec3 at) { return 2 + std::sin(at.x) * std::cos(0.7 * at.z); });
  const std::vector<FieldFit> all = rows.fit(samples);
  std::vector<std::uint32_t> given, wanted;
  for (std::uint32_t n = 0; n < rows.size(); ++n) {
    const double distance = length(rows.centre(n) - Vec3{8, 0, 8});
    if (distance < 2.5) wanted.push_back(static_cast<std::uint32_t>(given.size()));
    if (distance < 6.5) given.push_back(n);
  }
  ASSERT_GT(wanted.size(), 10u);
  ASSERT_LT(given.size(), rows.size());
  const std::vector<FieldFit> some = fit_some(rows, samples, given, wanted);
  for (const std::uint32_t k : wanted) {
    const FieldFit &a = some[given[k]], &b = all[given[k]];
    for (std::size_t c = 0; c < 6; ++c) EXPECT_EQ(a.coefficient[c].r, b.coefficient[c].r);
    EXPECT_EQ(a.window_misfit, b.window_misfit);
    EXPECT_EQ(a.variance, b.variance);
  }
}

TEST(FieldFit, ChangesAlongAWayByNoMoreThanItsRangeAllows) {
  FieldFit fit;
  fit.s = {1, 0, 0}, fit.t = {0, 1, 0};
  fit.low = {1, 1, 1}, fit.high = {2, 2, 2};
  for (const double slope : {0.5, 1e15}) {
    fit.coefficient = {RelativeLight{1.5, 1.5, 1.5}, RelativeLight{slope, slope, slope}};
    EXPECT_DOUBLE_EQ(fit.change_along({0.5, 0, 0}), slope < 1 ? 0.25 : 2);  // the range, half of its width wider on both sides
    EXPECT_EQ(fit.change_along({0, 0.5, 0}), 0);
  }
}

}  // namespace
}  // namespace alvor
