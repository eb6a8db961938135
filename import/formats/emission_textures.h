#pragma once
// Emission that varies over faces.

#include "meshing/placement.h"
#include "meshing/scene.h"

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace alvor {

/// The emissive textures of a scene that is being read. A material has one emission; so faces are cut into triangles where the
/// texture changes, and these get copies of the material with the texture's mean over each.
class EmissionTextures {
 public:
  /// Lets the emission of a material vary as an image does, by colour; the material's own emission is that of the whole image.
  void set(std::uint32_t material, std::shared_ptr<const ColourImage> image, Wrap wrap_s, Wrap wrap_t);
  bool has(std::uint32_t material) const { return textures_.contains(material); }
  /// Notes where the corners of the scene's newest face lie on the image of its material. A face that is not noted keeps the
  /// material's own emission. Requires: add_placed_face added the face with this placement, and one point for each corner.
  void place(const Scene& scene, std::span<const TexturePoint> points, const Placement& placement);
  /// Notes where the corners of a face lie.
  void place(std::uint32_t face, std::vector<TexturePoint> points) { faces_.push_back({face, std::move(points)}); }
  /// Cuts the faces, and appends materials and, for each texture, a sentence to `warnings`. Requires: the corners of all noted
  /// faces are vertices of the scene; the scene's objects have their faces.
  void cut(Scene& scene, std::vector<std::string>& warnings) const;

 private:
  struct Texture {
    std::shared_ptr<const ColourImage> image;
    Wrap wrap_s, wrap_t;
  };
  struct PlacedFace {
    std::uint32_t face;
    std::vector<TexturePoint> points;
  };

  std::map<std::uint32_t, Texture> textures_;  // by material
  std::vector<PlacedFace> faces_;
};

}  // namespace alvor
