// Tests of false colour: colour map, scale, legend and pictures.

#include "client/picture/colour_map.h"
#include "client/picture/legend.h"
#include "client/picture/round_number.h"
#include "client/picture/tone_map.h"
#include "tests/client/pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace alvor {
namespace {

Pixel shown(const Rgb& colour) { return {srgb_byte(colour.r), srgb_byte(colour.g), srgb_byte(colour.b)}; }

TEST(ColourMap, EndsAsDocumented) {
  EXPECT_EQ(shown(colour_map(0)), (Pixel{68, 1, 84}));
  EXPECT_EQ(shown(colour_map(1)), (Pixel{253, 231, 37}));
}

TEST(ColourMap, GetsLighterAllTheWay) {
  for (int i = 0; i < 1000; ++i) EXPECT_LT(luminance(colour_map(i / 1000.0)), luminance(colour_map((i + 1) / 1000.0))) << i;
}

TEST(ColourMap, PlacesOutsideGetTheEnds) {
  EXPECT_EQ(colour_map(-3), colour_map(0));
  EXPECT_EQ(colour_map(7), colour_map(1));
}

TEST(DivergingColourMap, IsWhiteInTheMiddleBlueBelowAndRedAbove) {
  EXPECT_EQ(shown(diverging_colour_map(0.5)), (Pixel{247, 247, 247}));
  for (const double off : {0.1, 0.3, 0.5}) {
    const Rgb below = diverging_colour_map(0.5 - off), above = diverging_colour_map(0.5 + off);
    EXPECT_GT(below.b, below.r) << off;
    EXPECT_GT(above.r, above.b) << off;
  }
}

TEST(ColourScale, ValuesOutsideGetTheEnds) {
  for (const bool logarithmic : {false, true}) {
    const ColourScale scale{2, 8, logarithmic};
    EXPECT_EQ(scale.position(-1), 0);
    EXPECT_EQ(scale.position(2), 0);
    EXPECT_EQ(scale.position(8), 1);
    EXPECT_EQ(scale.position(1e9), 1);
  }
}

TEST(ColourScale, EqualStepsOrEqualRatios) {
  EXPECT_DOUBLE_EQ((ColourScale{2, 8, false}).position(5), 0.5);
  EXPECT_DOUBLE_EQ((ColourScale{2, 8, true}).position(4), 0.5);
}

TEST(AutomaticScale, EndsRoundAboveAllButTheBrightestHundredth) {
  std::vector<double> values(1000, 3.1);
  values.front() = 1e6;
  const ColourScale scale = automatic_scale(values, false);
  EXPECT_EQ(scale.low, 0);
  EXPECT_EQ(scale.high, 5);
}

TEST(AutomaticScale, LogarithmicSpansOneToFourDecades) {
  const ColourScale narrow = automatic_scale({3, 3, 3}, true);
  EXPECT_GE(narrow.high / narrow.low, 10);
  const ColourScale wide = automatic_scale({1e-9, 1e-9, 3, 3, 3}, true);
  EXPECT_NEAR(wide.high / wide.low, 1e4, 1);
  EXPECT_TRUE(narrow.logarithmic && wide.logarithmic);
}

TEST(AutomaticScale, SuitsADarkPictureToo) {
  for (const bool logarithmic : {false, true})
    for (const std::vector<double>& values : {std::vector<double>{}, std::vector<double>{0, 0}}) {
      const ColourScale scale = automatic_scale(values, logarithmic);
      EXPECT_LT(scale.low, scale.high);
      EXPECT_TRUE(!logarithmic || scale.low > 0);
    }
}

bool is_round(double number) { return std::abs(RoundNumber::at_least(number).value() / number - 1) < 1e-12; }

const std::vector<ColourScale> scales{{0, 5, false},     {0, 1e-6, false},   {0.3, 4.7, false}, {-2, 7, false},
                                      {0, 20000, false}, {0.02, 2, true},    {1e-4, 1e4, true}, {3, 4, true},
                                      {0.3, 47, true},   {1e-30, 1e30, true}};

TEST(Ticks, LieWithinTheScaleInOrder) {
  for (const ColourScale& scale : scales) {
    const std::vector<double> found = ticks(scale, 8);
    ASSERT_FALSE(found.empty());
    EXPECT_GE(found.front(), scale.low);
    EXPECT_LE(found.back(), scale.high);
    EXPECT_LE(found.size(), 9u);  // eight steps have nine ends
    for (std::size_t i = 1; i < found.size(); ++i) EXPECT_LT(found[i - 1], found[i]);
  }
}

TEST(Ticks, AreMultiplesOfARoundStepOrRoundThemselves) {
  for (const ColourScale& scale : scales) {
    const std::vector<double> found = ticks(scale, 8);
    if (scale.logarithmic && scale.high / scale.low >= 10) {
      for (const double tick : found) EXPECT_TRUE(is_round(tick)) << tick;
      continue;
    }
    const double step = found[1] - found[0];
    EXPECT_TRUE(is_round(step)) << step;
    for (const double tick : found) EXPECT_NEAR(tick / step, std::round(tick / step), 1e-9) << tick;
  }
}

TEST(Ticks, ReadAsPeopleWriteThem) {
  std::string line;
  for (const double tick : ticks({0, 1, false}, 5)) line += short_text(tick) + " ";
  EXPECT_EQ(line, "0 0.2 0.4 0.6 0.8 1 ");
  EXPECT_EQ(short_text(2e-6), "2e-6");
  EXPECT_EQ(short_text(5e12), "5e12");
  EXPECT_EQ(short_text(0.123456), "0.1235");
}

TEST(Legend, LabelsBothEndsAndKeepsLabelsApart) {
  for (const ColourScale& scale : scales) {
    const auto labels = labels_of({scale, {}}, 0.05);
    EXPECT_EQ(labels.front().text, short_text(scale.low));
    EXPECT_EQ(labels.back().text, short_text(scale.high));
    for (std::size_t i = 1; i < labels.size(); ++i) EXPECT_GE(labels[i].position - labels[i - 1].position, 0.05 - 1e-12);
  }
}

TEST(Legend, SaysWhereValuesLieBeyondItsEnds) {
  const auto labels = labels_of({{1, 5, false}, {}, true, true}, 0.1);
  EXPECT_EQ(labels.front().text, "<= 1");
  EXPECT_EQ(labels.back().text, ">= 5");
}

TEST(Legend, IsLeftOutOfPicturesTooSmallForIt) {
  EXPECT_TRUE(legend_fits({1024, 768}));
  EXPECT_TRUE(legend_fits({320, 240}));
  EXPECT_FALSE(legend_fits({64, 48}));
  EXPECT_FALSE(legend_fits({100, 2000}));
}

/// Returns a picture of a wall of this mean irradiance on a scale from 0 to 4 W/m2.
Image measured(float irradiance, bool legend = false) {
  RenderOptions options;
  options.camera = facing_wall(256);
  options.false_colour = FalseColour{Band::mean, ColourScale{0, 4, false}, false, legend};
  return render(wall(RgbF{0.75f, 0.5f, 0.25f} * irradiance, 4), options);
}

TEST(FalseColour, UniformIrradianceHasOneColour) {
  const Image image = measured(2);
  std::set<Pixel> colours;
  for (int i = 70; i < 186; ++i)
    for (int j = 70; j < 186; ++j) colours.insert(pixel(image, i, j));
  EXPECT_EQ(colours, std::set{shown(colour_map(0.5))});
}

TEST(FalseColour, ValuesBeyondTheScaleGetItsTopColour) {
  EXPECT_EQ(pixel(measured(1e6f), 128, 128), shown(colour_map(1)));
  EXPECT_EQ(pixel(measured(0), 128, 128), shown(colour_map(0)));
}

TEST(FalseColour, BandsAreShownOneAtATime) {
  RenderOptions options;
  options.camera = facing_wall();
  for (const auto& [band, irradiance] : {std::pair{Band::red, 3.0}, {Band::green, 2.0}, {Band::blue, 1.0}, {Band::mean, 2.0}}) {
    options.false_colour = FalseColour{band, ColourScale{0, 4, false}, false, false};
    EXPECT_EQ(pixel(render(wall({1.5f, 1, 0.5f}), options), 32, 32), shown(colour_map(irradiance / 4)));
  }
}

TEST(FalseColour, ErrorsAreShownOnTheirOwn) {
  DisplayMesh mesh = wall(grey(2), 4);
  mesh.errors.assign(mesh.positions.size(), 1);
  RenderOptions options;
  options.camera = facing_wall();
  options.false_colour = FalseColour{Band::mean, ColourScale{0, 4, false}, false, false, Shown::error};
  EXPECT_EQ(pixel(render(mesh, options), 32, 32), shown(colour_map(0.25)));
}

TEST(FalseColour, EmittersShowWhatArrivesAtThem) {
  DisplayMesh lamp = wall(grey(50));
  std::ranges::fill(lamp.irradiance, grey(1));
  RenderOptions options;
  options.camera = facing_wall();
  options.false_colour = FalseColour{Band::mean, ColourScale{0, 4, false}, false, false};
  EXPECT_EQ(pixel(render(lamp, options), 32, 32), shown(colour_map(0.25)));
}

TEST(FalseColour, LegendStandsBesideTheViewAndHidesNothing) {
  const Image bare = measured(2), whole = measured(2, true);
  EXPECT_EQ(whole.width, bare.width + legend_width(bare.height));
  for (int y = 0; y < bare.height; y += 5)
    for (int x = 0; x < bare.width; x += 5) ASSERT_EQ(pixel(whole, x, y), pixel(bare, x, y)) << x << " " << y;
  std::set<Pixel> colours;
  for (int y = 0; y < whole.height; ++y)
    for (int x = bare.width; x < whole.width; ++x) colours.insert(pixel(whole, x, y));
  EXPECT_GT(colours.size(), 100u);  // from the legend's bar
}

TEST(FalseColour, PictureHasTheSizeThatWasAskedFor) {
  RenderOptions options;
  options.size = {320, 240};
  options.false_colour = FalseColour{};
  const Image image = render(hand_made_room(), options);
  EXPECT_EQ(image.width, 320);
  EXPECT_EQ(image.height, 240);
}

TEST(FalseColour, WireframeDrawsOutlinesOverTheColours) {
  RenderOptions options;
  options.camera = facing_wall();
  options.false_colour = FalseColour{Band::mean, ColourScale{0, 4, false}, false, false};
  options.wireframe = true;
  for (const float irradiance : {0.0f, 2.0f, 4.0f}) {
    const Image image = render(wall(grey(irradiance / 2), 2), options);
    const Pixel line = pixel(image, 32, 26), centre = pixel(image, 24, 24);
    EXPECT_EQ(centre, shown(colour_map(irradiance / 4)));
    EXPECT_GT(std::abs(line[1] - centre[1]), 20) << irradiance;
  }
}

}  // namespace
}  // namespace alvor
