#pragma once
// A scene as it was submitted: plain faces and materials, nothing welded, nothing derived.

#include "meshing/vec3.h"
#include "solution/rgb.h"

#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace alvor {

/// What importers and the API take a reflectance of 1 for: where all is reflected light goes round for ever.
inline constexpr double clamped_reflectance = 0.95;

struct Material {
  std::string name;
  Rgb emission;     ///< E: radiant exitance, W/m2 per band, >= 0
  Rgb reflectance;  ///< rho: diffuse, in [0, 1) per band
  bool two_sided = false;
};

/// A polygon whose corners are scene.corners[first_corner .. first_corner + corner_count), counter-clockwise seen from its front.
struct Face {
  std::uint32_t first_corner = 0;
  std::uint32_t corner_count = 0;  ///< >= 3
  std::uint32_t material = 0;
};

/// The axis that points up. It changes no light, only how pictures are drawn and which way a solution file stands.
enum class UpAxis : std::uint8_t { y, z };

struct Scene {
  std::vector<Vec3> vertices;          ///< metres
  std::vector<std::uint32_t> corners;  ///< indices of vertices
  std::vector<Face> faces;
  std::vector<Material> materials;
  Rgb absorption;  ///< of the medium that fills the scene, 1/m per band, >= 0: light fades by exp(-absorption r). 0: none
  UpAxis up = UpAxis::y;

  std::span<const std::uint32_t> corners_of(const Face& face) const {
    return std::span(corners).subspan(face.first_corner, face.corner_count);
  }
  /// Appends a face. No check is made: see find_fault.
  void add_face(std::span<const std::uint32_t> polygon, std::uint32_t material);
  /// The same, with vertices of its own.
  void add_polygon(std::span<const Vec3> polygon, std::uint32_t material);
};

/// Radiant exitance of a diffuse emitter of this radiance: E = pi L.
constexpr Rgb emission_of_radiance(const Rgb& radiance) { return std::numbers::pi * radiance; }

/// Why a scene cannot be solved: the place ("face 3", "vertex 12", "material 'wall'") and the reason.
struct Fault {
  std::string place;
  std::string reason;
  std::string text() const { return place + ": " + reason; }
};

/// The first fault, looking at counts, then materials, vertices and faces in order. Linear in the size of the scene; never reads
/// out of bounds, whatever the scene. A scene without fault has at least one face, finite coordinates within 1e9 m, indices in
/// range, faces of three corners or more, emission in [0, 1e30] W/m2, finite absorption >= 0 and reflectance in [0, 1).
/// Degenerate faces are no fault.
std::optional<Fault> find_fault(const Scene& scene);

}  // namespace alvor
