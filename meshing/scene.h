#pragma once
// A scene as it was submitted: faces and materials, before welding and any other processing.

#include "meshing/light.h"
#include "meshing/scene_object.h"
#include "meshing/texture.h"
#include "meshing/vec3.h"
#include "solution/rgb.h"

#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace alvor {

/// Importers and the API replace a reflectance of 1 by this value: light in a room that reflects everything would never fade.
inline constexpr double clamped_reflectance = 0.95;

struct Material {
  std::string name;
  Rgb emission;     ///< E: radiant exitance, W/m2 per band, >= 0
  Rgb reflectance;  ///< rho: diffuse, in [0, 1) per band; the mean of what the texture's image does not cut out, if there is one
  bool two_sided = false;
  /// Share of light that goes straight on through a face, from either side, tinted: of clear glass, or of what holes leave of a
  /// cloth (CIE: regular transmittance). In [0, 1] per band, and at most 1 with the reflectance.
  Rgb regular_transmittance;
  std::optional<Texture> texture;  ///< the reflectance by place, and what is cut out
  /// tau: share of light that a face scatters into all directions behind it, from either side: of paper, cloth, a lamp shade
  /// (CIE: diffuse transmittance). In [0, 1) per band, and below 1 with the reflectance. Needs two sides.
  Rgb diffuse_transmittance{};

  /// Returns whether light goes straight through some place of a face.
  bool is_pane() const { return !regular_transmittance.is_zero() || has_cutout(); }
  /// Returns whether parts of a face are holes, as the texture's image says.
  bool has_cutout() const { return texture && texture->image && texture->image->has_opacity; }
  bool is_translucent() const { return !diffuse_transmittance.is_zero(); }
  /// Returns an upper bound on the reflectance of any place, below 1.
  Rgb largest_reflectance() const { return texture && texture->image ? texture->largest_reflectance() : reflectance; }
  /// Returns an upper bound on the share of light that any place scatters, to both sides together; below 1.
  Rgb largest_albedo() const { return largest_reflectance() + diffuse_transmittance; }
};

/// A polygon. Its corners are scene.corners[first_corner .. first_corner + corner_count), counter-clockwise seen from its front.
struct Face {
  std::uint32_t first_corner = 0;
  std::uint32_t corner_count = 0;  ///< >= 3
  std::uint32_t material = 0;
};

/// The quantity in which a scene counts light: watts of radiation, or lumens, as eyes weigh it. In a photometric scene all that
/// is said in W, W/m2, W/sr and W/m2 sr is lm, lx, cd and cd/m2 per band; the luminous value is 0.2126 r + 0.7152 g + 0.0722 b
/// (Rec. 709).
enum class Quantity : std::uint8_t { radiometric, photometric };

/// The axis that points up. It does not affect the light; it orients pictures and solution files.
enum class UpAxis : std::uint8_t { y, z };

/// Returns the turn about x that brings what stands upright where `from` points up to where `to` does.
constexpr Placement turn_upright(UpAxis from, UpAxis to) {
  if (from == to) return {};
  return to == UpAxis::z ? Placement{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {}} : Placement{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {}};
}

struct Scene {
  std::vector<Vec3> vertices;          ///< metres
  std::vector<std::uint32_t> corners;  ///< indices of vertices
  /// Where on the texture of its face's material each corner lies; none if no material has a texture.
  std::vector<TexturePoint> texture_points;
  /// What the reflectance is multiplied by at each corner, in [0, 1] per band, linear in between; none if no face has colours.
  std::vector<RgbF> corner_colours;
  std::vector<Face> faces;
  std::vector<Material> materials;
  /// Absorption coefficient of the medium that fills the scene, 1/m per band, >= 0. Light fades by exp(-absorption r); 0 means no
  /// medium.
  Rgb absorption;
  std::vector<Light> lights;         ///< those that are not faces
  std::vector<SceneObject> objects;  ///< none if the faces have no names; a face may belong to no object
  UpAxis up = UpAxis::y;
  /// The angle from -z (if z is up: from y) to north, clockwise seen from above. It does not affect the light.
  double north_degrees = 0;
  Quantity quantity = Quantity::radiometric;

  std::span<const std::uint32_t> corners_of(const Face& face) const {
    return std::span(corners).subspan(face.first_corner, face.corner_count);
  }
  /// Returns the texture point of each corner of a face; nothing if its material has no texture.
  std::span<const TexturePoint> texture_points_of(const Face& face) const {
    if (!materials[face.material].texture) return {};
    return std::span(texture_points).subspan(face.first_corner, face.corner_count);
  }
  /// Returns the colour of each corner of a face; nothing if the scene has none.
  std::span<const RgbF> colours_of(const Face& face) const {
    if (corner_colours.empty()) return {};
    return std::span(corner_colours).subspan(face.first_corner, face.corner_count);
  }
  /// Appends a face. Does not check it; find_fault does. `points` and `colours` have an entry for each corner, or none.
  void add_face(std::span<const std::uint32_t> polygon, std::uint32_t material, std::span<const TexturePoint> points = {},
                std::span<const RgbF> colours = {});
  /// Appends a face with new vertices. Does not check it; find_fault does.
  void add_polygon(std::span<const Vec3> polygon, std::uint32_t material);
};

/// Returns the radiant exitance of a diffuse emitter of this radiance: E = pi L.
constexpr Rgb emission_of_radiance(const Rgb& radiance) { return std::numbers::pi * radiance; }

/// The reason why a scene cannot be solved, and its place: "face 3", "vertex 12", "material 'wall'".
struct Fault {
  std::string place;
  std::string reason;
  std::string text() const { return place + ": " + reason; }
};

/// Returns the first fault of the scene; looks at counts, then materials, lights, vertices, faces and objects in order. Linear in
/// the size of the scene; never reads out of bounds, whatever the scene holds. A scene without fault has at least one face,
/// finite coordinates within 1e9 m, indices in range, faces of three corners or more, emission in [0, 1e30] W/m2, finite
/// absorption >= 0, reflectance and diffuse transmittance in [0, 1) and below 1 together, at most 1 with the regular
/// transmittance, two sides where the diffuse transmittance is not 0, sound images, texture points for all corners if any
/// material has a texture, colours in [0, 1] for all corners or none, and objects of different names in an order that fits the
/// faces. Degenerate faces are no fault.
std::optional<Fault> find_fault(const Scene& scene);

}  // namespace alvor
