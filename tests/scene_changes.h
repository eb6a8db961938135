#pragma once
// Changes a scene so that its solution stays the same, or becomes a known multiple.

#include "meshing/scene.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace alvor::test {

inline Scene with_emission_times(Scene scene, double factor) {
  for (Material& material : scene.materials) material.emission *= factor;
  return scene;
}

/// Returns the scene in another unit of length. The medium absorbs as much from wall to wall as before.
inline Scene with_lengths_times(Scene scene, double factor) {
  for (Vec3& vertex : scene.vertices) vertex = factor * vertex;
  scene.absorption = (1 / factor) * scene.absorption;
  return scene;
}

template <class T>
RgbOf<T> red_and_green_swapped(const RgbOf<T>& bands) {
  return {bands.g, bands.r, bands.b};
}

inline Scene with_red_and_green_swapped(Scene scene) {
  for (Material& material : scene.materials) {
    material.emission = red_and_green_swapped(material.emission);
    material.reflectance = red_and_green_swapped(material.reflectance);
    material.regular_transmittance = red_and_green_swapped(material.regular_transmittance);
    material.diffuse_transmittance = red_and_green_swapped(material.diffuse_transmittance);
    if (!material.texture) continue;
    ColourImage image = *material.texture->image;
    for (std::size_t texel = 0; texel < image.texels.size(); texel += image.bytes_a_texel()) std::swap(image.texels[texel], image.texels[texel + 1]);
    material.texture->image = std::make_shared<const ColourImage>(std::move(image));
    material.texture->factor = red_and_green_swapped(material.texture->factor);
  }
  for (RgbF& colour : scene.corner_colours) colour = red_and_green_swapped(colour);
  scene.absorption = red_and_green_swapped(scene.absorption);
  return scene;
}

/// Returns the texture points of a face's corners; nothing if the scene has none.
inline std::vector<TexturePoint> points_of(const Scene& scene, std::uint32_t face) {
  if (scene.texture_points.empty()) return {};
  const auto first = scene.texture_points.begin() + scene.faces[face].first_corner;
  return {first, first + scene.faces[face].corner_count};
}

/// Returns the colours of a face's corners; nothing if the scene has none.
inline std::vector<RgbF> colours_of(const Scene& scene, std::uint32_t face) {
  const auto colours = scene.colours_of(scene.faces[face]);
  return {colours.begin(), colours.end()};
}

/// Returns the scene with its faces reordered: face n is face order[n] of `scene`.
inline Scene with_faces_in_order(const Scene& scene, std::span<const std::uint32_t> order) {
  Scene changed = scene;
  changed.corners.clear(), changed.faces.clear(), changed.texture_points.clear(), changed.corner_colours.clear();
  for (const std::uint32_t face : order)
    changed.add_face(scene.corners_of(scene.faces[face]), scene.faces[face].material, points_of(scene, face),
                     colours_of(scene, face));
  return changed;
}

/// Returns the scene with each two-sided face as two one-sided ones with the same corners, the backs after all fronts.
inline Scene with_backs_as_faces(const Scene& scene) {
  Scene changed = scene;
  for (Material& material : changed.materials) material.two_sided = false;
  for (std::uint32_t f = 0; f < scene.faces.size(); ++f) {
    const Face& face = scene.faces[f];
    if (!scene.materials[face.material].two_sided) continue;
    std::vector<std::uint32_t> ring(scene.corners_of(face).begin(), scene.corners_of(face).end());
    std::vector<TexturePoint> points = points_of(scene, f);
    std::reverse(ring.begin() + 1, ring.end());
    std::vector<RgbF> colours = colours_of(scene, f);
    if (!points.empty()) std::reverse(points.begin() + 1, points.end());
    if (!colours.empty()) std::reverse(colours.begin() + 1, colours.end());
    changed.add_face(ring, face.material, points, colours);
  }
  return changed;
}

/// Returns the scene with a triangle or quad cut from its first corner to the middle of its second edge; the cut-off triangle is
/// the last face.
inline Scene with_face_cut(const Scene& scene, std::uint32_t face) {
  Scene changed = scene;
  changed.corners.clear(), changed.faces.clear(), changed.texture_points.clear(), changed.corner_colours.clear();
  const std::vector<TexturePoint> of_face = points_of(scene, face);
  const auto middle =
      of_face.empty() ? TexturePoint{} : TexturePoint{(of_face[1].s + of_face[2].s) / 2, (of_face[1].t + of_face[2].t) / 2};
  const std::vector<RgbF> face_colours = colours_of(scene, face);
  const RgbF middle_colour = face_colours.empty() ? RgbF{} : 0.5F * (face_colours[1] + face_colours[2]);
  for (std::uint32_t f = 0; f < scene.faces.size(); ++f) {
    const auto corners = scene.corners_of(scene.faces[f]);
    std::vector<std::uint32_t> ring(corners.begin(), corners.end());
    std::vector<TexturePoint> points = points_of(scene, f);
    std::vector<RgbF> colours = colours_of(scene, f);
    if (f == face) {
      if (!colours.empty()) colours[1] = middle_colour;
      if (!points.empty()) points[1] = middle;
      changed.vertices.push_back(lerp(scene.vertices[ring[1]], scene.vertices[ring[2]], 0.5));
      ring[1] = static_cast<std::uint32_t>(scene.vertices.size());
    }
    changed.add_face(ring, scene.faces[f].material, points, colours);
  }
  const auto corners = scene.corners_of(scene.faces[face]);
  std::vector<TexturePoint> points;
  std::vector<RgbF> colours;
  if (!of_face.empty()) points = {of_face[0], of_face[1], middle};
  if (!face_colours.empty()) colours = {face_colours[0], face_colours[1], middle_colour};
  changed.add_face(std::vector{corners[0], corners[1], static_cast<std::uint32_t>(scene.vertices.size())},
                   scene.faces[face].material, points, colours);
  return changed;
}

}  // namespace alvor::test
