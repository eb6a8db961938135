// The part of codec.h for lights, their webs and environment maps.

#include "proto/light_codec.h"

#include "proto/codec.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace alvor {

v1::Vector3 encode_vector(Vec3 v) {
  v1::Vector3 message;
  message.set_x(v.x);
  message.set_y(v.y);
  message.set_z(v.z);
  return message;
}

Vec3 decode_vector(const v1::Vector3& message) { return {message.x(), message.y(), message.z()}; }

namespace {

v1::Light::Kind encode_kind(LightKind kind) {
  switch (kind) {
    case LightKind::point: return v1::Light::POINT;
    case LightKind::spot: return v1::Light::SPOT;
    case LightKind::directional: return v1::Light::DIRECTIONAL;
    case LightKind::luminaire: return v1::Light::LUMINAIRE;
    case LightKind::sky: return v1::Light::SKY;
    case LightKind::environment: return v1::Light::ENVIRONMENT;
  }
  return v1::Light::KIND_UNSPECIFIED;
}

/// Requires: the kind is known.
LightKind decode_kind(v1::Light::Kind kind) {
  switch (kind) {
    case v1::Light::SPOT: return LightKind::spot;
    case v1::Light::DIRECTIONAL: return LightKind::directional;
    case v1::Light::LUMINAIRE: return LightKind::luminaire;
    case v1::Light::SKY: return LightKind::sky;
    case v1::Light::ENVIRONMENT: return LightKind::environment;
    default: return LightKind::point;
  }
}

// The shapes of the API are those of LuminousOpening::Shape in their order, after SHAPE_UNSPECIFIED.
v1::LuminousOpening encode_opening(const LuminousOpening& opening) {
  v1::LuminousOpening message;
  message.set_shape(static_cast<v1::LuminousOpening::Shape>(static_cast<int>(opening.shape) + 1));
  message.set_across_meters(opening.across);
  message.set_along_meters(opening.along);
  message.set_height_meters(opening.height);
  return message;
}

LuminousOpening decode_opening(const v1::LuminousOpening& message) {
  const int shape = std::max(0, static_cast<int>(message.shape()) - 1);
  return {static_cast<LuminousOpening::Shape>(shape), message.across_meters(), message.along_meters(), message.height_meters()};
}

v1::SkyDistribution encode_sky(const SkyDistribution& sky) {
  v1::SkyDistribution message;
  message.set_a(sky.a);
  message.set_b(sky.b);
  message.set_c(sky.c);
  message.set_d(sky.d);
  message.set_e(sky.e);
  message.set_g(sky.g);
  *message.mutable_to_sun() = encode_vector(sky.to_sun);
  return message;
}

SkyDistribution decode_sky(const v1::SkyDistribution& message) {
  SkyDistribution sky{message.a(), message.b(), message.c(), message.d(), message.e(), message.g()};
  if (message.has_to_sun()) sky.to_sun = decode_vector(message.to_sun());
  return sky;
}

}  // namespace

Light decode_light(const v1::Light& message) {
  Light light;
  light.name = message.name();
  light.kind = decode_kind(message.kind());
  light.intensity = decode(message.intensity());
  if (message.has_position()) light.position = decode_vector(message.position());
  if (message.has_direction()) light.direction = decode_vector(message.direction());
  if (light.kind == LightKind::spot) {
    light.inner_cone = message.inner_cone_radians();
    light.outer_cone = message.outer_cone_radians();
  }
  light.radius = message.radius_meters();
  light.angular_diameter = message.angular_diameter_radians();
  if (message.has_across()) light.across = decode_vector(message.across());
  if (message.has_opening()) light.opening = decode_opening(message.opening());
  light.electrical_watts = message.electrical_watts();
  light.is_hidden = message.hidden();
  if (message.has_sky()) light.sky = decode_sky(message.sky());
  return light;
}

// The skies of the API are those of Daylight::Sky in their order.
v1::Daylight encode(const Daylight& daylight) {
  v1::Daylight message;
  if (const auto* stands = std::get_if<SunPosition>(&daylight.sun)) {
    message.set_sun_azimuth_degrees(stands->azimuth);
    message.set_sun_elevation_degrees(stands->elevation);
  } else if (const auto* seen = std::get_if<SunTime>(&daylight.sun)) {
    message.mutable_sun_time()->set_latitude_degrees(seen->place.latitude);
    message.mutable_sun_time()->set_longitude_degrees(seen->place.longitude);
    const double second = std::floor(seen->unix_seconds);
    message.mutable_sun_time()->mutable_time()->set_seconds(static_cast<std::int64_t>(second));
    message.mutable_sun_time()->mutable_time()->set_nanos(
        static_cast<std::int32_t>(std::min(999'999'999L, std::lround(1e9 * (seen->unix_seconds - second)))));
  }
  if (daylight.sun_irradiance) message.set_sun_irradiance(*daylight.sun_irradiance);
  message.set_sky(static_cast<v1::Daylight::Sky>(daylight.sky));
  message.set_cie_number(static_cast<std::uint32_t>(daylight.cie_number));
  message.set_direct_normal_watts(daylight.direct_normal_watts);
  message.set_diffuse_horizontal_watts(daylight.diffuse_horizontal_watts);
  if (daylight.sky_irradiance) message.set_sky_irradiance(*daylight.sky_irradiance);
  message.set_ground_reflectance(daylight.ground_reflectance);
  message.set_north_degrees(daylight.north_degrees);
  return message;
}

std::optional<Daylight> decode_daylight(const v1::Daylight& message) {
  if (!v1::Daylight::Sky_IsValid(message.sky())) return std::nullopt;
  Daylight daylight;
  if (message.has_sun_azimuth_degrees())
    daylight.sun = SunPosition{message.sun_azimuth_degrees(), message.sun_elevation_degrees()};
  if (message.has_sun_time()) {
    const v1::SunTime& seen = message.sun_time();
    const double seconds = static_cast<double>(seen.time().seconds()) + 1e-9 * seen.time().nanos();
    daylight.sun = SunTime{{seen.latitude_degrees(), seen.longitude_degrees()}, seconds};
  }
  if (message.has_sun_irradiance()) daylight.sun_irradiance = message.sun_irradiance();
  daylight.sky = static_cast<Daylight::Sky>(message.sky());
  daylight.cie_number = static_cast<int>(std::min<std::uint32_t>(message.cie_number(), std::numeric_limits<int>::max()));
  daylight.direct_normal_watts = message.direct_normal_watts();
  daylight.diffuse_horizontal_watts = message.diffuse_horizontal_watts();
  if (message.has_sky_irradiance()) daylight.sky_irradiance = message.sky_irradiance();
  daylight.ground_reflectance = message.ground_reflectance();
  daylight.north_degrees = message.north_degrees();
  return daylight;
}

v1::Light encode(const Light& light) {
  v1::Light message;
  message.set_name(as_utf8(light.name));
  message.set_kind(encode_kind(light.kind));
  *message.mutable_intensity() = encode(light.intensity);
  if (!light.is_distant()) *message.mutable_position() = encode_vector(light.position);
  if (light.kind != LightKind::point) *message.mutable_direction() = encode_vector(light.direction);
  if (light.kind == LightKind::spot) {
    message.set_inner_cone_radians(light.inner_cone);
    message.set_outer_cone_radians(light.outer_cone);
  }
  message.set_radius_meters(light.radius);
  message.set_angular_diameter_radians(light.angular_diameter);
  if (light.kind == LightKind::luminaire || light.kind == LightKind::environment)
    *message.mutable_across() = encode_vector(light.across);
  if (light.kind == LightKind::luminaire) *message.mutable_opening() = encode_opening(light.opening);
  message.set_electrical_watts(light.electrical_watts);
  message.set_hidden(light.is_hidden);
  if (light.kind == LightKind::sky) *message.mutable_sky() = encode_sky(light.sky);
  return message;
}

v1::PhotometricWeb encode(const PhotometricWeb& web) {
  v1::PhotometricWeb message;
  message.set_axis(web.axis == PhotometricWeb::Axis::across ? v1::PhotometricWeb::ACROSS : v1::PhotometricWeb::AIM);
  message.mutable_plane_degrees()->Assign(web.planes.begin(), web.planes.end());
  message.mutable_angle_degrees()->Assign(web.angles.begin(), web.angles.end());
  message.mutable_intensities()->Assign(web.intensities.begin(), web.intensities.end());
  return message;
}

PhotometricWeb decode(const v1::PhotometricWeb& message) {
  PhotometricWeb web;
  web.axis = message.axis() == v1::PhotometricWeb::ACROSS ? PhotometricWeb::Axis::across : PhotometricWeb::Axis::aim;
  web.planes.assign(message.plane_degrees().begin(), message.plane_degrees().end());
  web.angles.assign(message.angle_degrees().begin(), message.angle_degrees().end());
  web.intensities.assign(message.intensities().begin(), message.intensities().end());
  return web;
}

v1::EnvironmentMap encode(const EnvironmentMap& map) {
  v1::EnvironmentMap message;
  message.set_columns(map.grid.columns);
  message.set_rows(map.grid.rows);
  for (const RgbF& pixel : map.pixels)
    for (const float band : {pixel.r, pixel.g, pixel.b}) message.add_radiance(band);
  return message;
}

EnvironmentMap decode(const v1::EnvironmentMap& message) {
  EnvironmentMap map{{message.columns(), message.rows()}, {}};
  for (int n = 0; n + 2 < message.radiance_size(); n += 3)
    map.pixels.push_back({message.radiance(n), message.radiance(n + 1), message.radiance(n + 2)});
  return map;
}

}  // namespace alvor
