// Sun, sky and ground: where they are and how bright, and what is refused.

#include "meshing/daylight.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alvor {
namespace {

constexpr double noon_of_june_21 = 1'782'043'200;  // 2026-06-21 12:00 UTC
constexpr Geolocation greenwich{51.48, 0};

std::vector<Light> lights(const Daylight& daylight, Quantity quantity = Quantity::photometric) {
  EXPECT_FALSE(fault_in(daylight));
  return lights_of(daylight, quantity, UpAxis::z, usual_lumens_per_watt);
}

TEST(Daylight, TheSunShinesFromWhereItStands) {
  const auto made = lights({.sun = SunPosition{90, 30}});
  ASSERT_EQ(made.size(), 1u);
  EXPECT_LT(length(made[0].direction - Vec3{-std::sqrt(0.75), 0, -0.5}), 1e-12) << "it stands in the east";
  EXPECT_NEAR(made[0].intensity.g, clear_sky(30).sun, 1e-9);
  const auto turned = lights({.sun = SunPosition{90, 30}, .north_degrees = 90});
  EXPECT_LT(length(turned[0].direction - Vec3{0, std::sqrt(0.75), -0.5}), 1e-12) << "east is -y where north is x";
}

TEST(Daylight, PlaceAndTimeSayWhereTheSunStands) {
  const auto sun = position_of_sun({.sun = SunTime{greenwich, noon_of_june_21}});
  ASSERT_TRUE(sun);
  EXPECT_NEAR(sun->elevation, 90 - 51.48 + 23.44, 0.05) << "solstice: latitude and obliquity alone say how high it is at noon";
  EXPECT_NEAR(sun->azimuth, 180, 1.5) << "the equation of time is under two minutes then";
  EXPECT_FALSE(position_of_sun({}));
}

TEST(Daylight, TheGroundReflectsWhatFallsOnIt) {
  const auto made = lights({.sun = SunPosition{180, 30},
                            .sun_irradiance = 1000,
                            .sky = Daylight::Sky::uniform,
                            .sky_irradiance = 200,
                            .ground_reflectance = 0.5});
  ASSERT_EQ(made.size(), 3u);
  EXPECT_NEAR(made[2].intensity.g, 0.5 * (1000 * 0.5 + 200), 1e-9);
  EXPECT_EQ(made[2].direction, (Vec3{0, 0, 1}));
}

TEST(Daylight, AtNightOnlyASkyOfItsOwnShines) {
  EXPECT_TRUE(lights({.sun = SunPosition{0, -10}, .ground_reflectance = 0.2}).empty());
  EXPECT_TRUE(lights({.sun = SunPosition{0, 0.1}}).empty()) << "the model has 1e-47 lx";
  const auto made = lights({.sun = SunPosition{0, -10}, .sky = Daylight::Sky::overcast, .sky_irradiance = 3});
  ASSERT_EQ(made.size(), 1u);
  EXPECT_EQ(made[0].name, "sky");
}

TEST(Daylight, ScenesInWattsHaveLumensOfDaylight) {
  const Daylight clear{.sun = SunPosition{180, 40}, .sky = Daylight::Sky::cie, .cie_number = 12};
  const auto lux = lights(clear), watts = lights(clear, Quantity::radiometric);
  for (std::size_t n = 0; n < 2; ++n) EXPECT_NEAR(lux[n].intensity.g, 179 * watts[n].intensity.g, 1e-6 * lux[n].intensity.g);
}

TEST(Daylight, RefusesWhatCannotBe) {
  using Sky = Daylight::Sky;
  for (const auto& [daylight, text] : std::vector<std::pair<Daylight, std::string>>{
           {{.sun = SunPosition{NAN, 0}}, "its azimuth of the sun is out of range"},
           {{.sun = SunPosition{0, 91}}, "its elevation of the sun is out of range"},
           {{.sun = SunTime{{91, 0}, 0}}, "its latitude is out of range"},
           {{.sun = SunTime{{0, NAN}, 0}}, "its longitude is out of range"},
           {{.sun = SunTime{{0, 0}, 1e12}}, "its time is out of range"},
           {{.sun_irradiance = 1}, "it is not said where the sun stands"},
           {{.sky = Sky::cie, .cie_number = 12}, "it is not said where the sun stands"},
           {{.sun = SunPosition{}, .sky = Sky::cie, .cie_number = 16}, "its number of a CIE sky is out of range"},
           {{.sun = SunPosition{}, .sky = Sky::perez}, "the sky of Perez needs a diffuse horizontal irradiance"},
           {{.sky_irradiance = 1}, "has an irradiance from a sky, but no sky"},
           {{.sky = Sky::uniform, .sky_irradiance = -1}, "its irradiance from the sky is out of range"},
           {{.ground_reflectance = 0.2}, "the ground needs a sun or a sky that lights it"},
           {{.sky = Sky::uniform, .ground_reflectance = 1.5}, "its reflectance of the ground is out of range"}})
    EXPECT_EQ(fault_in(daylight), text);
}

}  // namespace
}  // namespace alvor
