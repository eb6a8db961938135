#include "client/bake/vertex_bake.h"

#include "client/bake/materials.h"
#include "client/bake/placed_meshes.h"
#include "client/bake/texels.h"
#include "client/picture/tone_map.h"
#include "import/base/bytes.h"
#include "import/base/glb_format.h"
#include "meshing/mesh_area.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace alvor {

namespace {

using nlohmann::json;

// Share of the way from a corner to the middle of its triangle at which its light is read: at the corner itself another surface
// often begins. Chosen.
constexpr double inwards = 0.02;
// Shares of that way at which a corner that is covered looks for light. Chosen.
constexpr double further_inwards[]{inwards, 0.1, 0.3, 0.6};
// Share of the mean irradiance below which what a covered point sees counts as dark. Chosen.
constexpr double darkness = 0.01;

/// What was solved at a vertex: the mean over its triangles by their area.
struct VertexLight {
  Rgb irradiance, radiosity;
  double weight = 0;
};

/// Returns the mean over the area of the irradiance at the middles of leaves, W/m2.
double mean_irradiance(const DisplayMesh& solution) {
  double power = 0, area = 0;
  for (std::uint32_t t = 0; t < solution.triangles.size(); ++t) {
    const double here = area_of(solution, t);
    power += here * widen(solution.irradiance[solution.triangles[t][0]]).mean(), area += here;
  }
  return area > 0 ? power / area : 0;
}

class VertexBaker {
 public:
  VertexBaker(GltfDocument document, const Scene& scene, const DisplayMesh& solution, BakedSide side)
      : document_(std::move(document)),
        scene_(scene),
        exposure_(automatic_exposure(solution)),
        surface_(solution, scene),
        dark_(darkness * mean_irradiance(solution)),
        meshes_(placed_meshes(document_, Cutting::none)),
        side_(side) {}

  Baked bake() {
    check_objects(meshes_, scene_);
    rewrite_meshes(document_, meshes_, [&](const MeshNode& node, const PrimitiveCharts& mesh, const json& primitive) {
      return std::vector{written(node, mesh, primitive)};
    });
    baked_.nodes = meshes_.nodes.size();
    baked_.glb = document_.encode();
    return std::move(baked_);
  }

 private:
  json written(const MeshNode& node, const PrimitiveCharts& mesh, json primitive) {
    const json material = material_of(primitive, document_);
    if (mesh.triangles.empty() || shows_what_is_behind(material)) return primitive;
    Chart all;
    all.triangles.resize(mesh.triangles.size());
    std::iota(all.triangles.begin(), all.triangles.end(), 0u);
    const PlacedChart placed{
        mesh.positions, &mesh.charts, &all, to_scene(scene_) * node.placement, node.object, is_two_sided(primitive, document_)};
    const ShownSide side = shown_side(placed, surface_, side_);
    baked_.lit_from_both += side.loses_light;
    ++baked_.charts;
    std::vector<std::array<float, 4>> colours(mesh.positions.size(), {1, 1, 1, 1});
    if (primitive["attributes"].contains("COLOR_0"))
      colours = document_.read_colours(index_in(primitive["attributes"], "COLOR_0", "primitive"));
    if (colours.size() != mesh.positions.size()) throw BakeError("COLOR_0", "has not as many elements as POSITION");
    // A material that glows, or whose base colour has no image, gets the colour of the picture itself, which may be brighter than
    // the base colour.
    const bool is_whole = emits_light(material) || !has_base_image(material);
    const std::vector<VertexLight> light = light_at_vertices(placed, side.is_back);
    std::string bytes;
    for (std::size_t v = 0; v < colours.size(); ++v) {
      const Rgb shown = colour_of(light[v], is_whole);
      for (std::size_t band = 0; band < 3; ++band) {
        const double factor = (&shown.r)[band] * (is_whole ? 1 : double(colours[v][band]));
        append_value(bytes, static_cast<float>(std::clamp(factor, 0.0, 1.0)));
      }
      append_value(bytes, colours[v][3]);
    }
    primitive["attributes"]["COLOR_0"] = document_.add_accessor({{"componentType", glb::float_component}, {"type", "VEC4"}},
                                                                bytes, colours.size(), glb::array_buffer);
    primitive["material"] = unlit_material(primitive, material, is_whole);
    return primitive;
  }

  std::vector<VertexLight> light_at_vertices(const PlacedChart& placed, bool is_back) const {
    std::vector<VertexLight> light(placed.positions.size());
    const auto& triangles = placed.mesh->triangles;
    std::vector<std::array<std::optional<SolvedSurface::Sample>, 3>> samples(triangles.size());
    tbb::parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t t) {
      const auto number = static_cast<std::uint32_t>(t);
      const Vec3 normal = (is_back ? -1.0 : 1.0) * placed_normal(placed, number);
      for (std::size_t c = 0; c < 3 && normal != Vec3{}; ++c)
        for (const double share : further_inwards) {
          const double near = share / 3, far = 1 - 2 * near;
          const auto [u, v] = std::array<std::array<double, 2>, 3>{{{near, near}, {far, near}, {near, far}}}[c];
          if ((samples[t][c] = uncovered(placed.object, placed_point(placed, number, u, v), normal))) break;
        }
    });
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto [a, b, d] = placed_corners(placed, static_cast<std::uint32_t>(t));
      const double area = length(cross(b - a, d - a));
      for (std::size_t c = 0; c < 3; ++c) {
        if (!samples[t][c]) continue;
        VertexLight& at = light[triangles[t][c]];
        at.irradiance += area * samples[t][c]->irradiance, at.radiosity += area * samples[t][c]->smooth_radiosity,
            at.weight += area;
      }
    }
    take_on(light, triangles);
    return light;
  }

  /// Returns what was solved at a point; nothing below what stands there.
  std::optional<SolvedSurface::Sample> uncovered(std::size_t object, Vec3 point, Vec3 normal) const {
    const auto sample = surface_.at(object, point, normal);
    return sample && surface_.is_covered(point, normal, dark_) ? std::nullopt : sample;
  }

  /// Gives covered vertices the mean light of their neighbours, ring by ring.
  static void take_on(std::vector<VertexLight>& light, std::span<const MeshTriangle> triangles) {
    for (bool has_changed = true; has_changed;) {
      std::vector<VertexLight> taken(light.size());
      for (const MeshTriangle& triangle : triangles)
        for (const std::uint32_t to : triangle)
          for (const std::uint32_t from : triangle) {
            if (light[to].weight > 0 || !(light[from].weight > 0)) continue;
            taken[to].irradiance += light[from].irradiance * (1 / light[from].weight);
            taken[to].radiosity += light[from].radiosity * (1 / light[from].weight);
            taken[to].weight += 1;
          }
      has_changed = false;
      for (std::size_t v = 0; v < light.size(); ++v)
        if (taken[v].weight > 0) light[v] = taken[v], has_changed = true;
    }
  }

  /// Returns by what the base colour is multiplied to look as in a picture, or the colour of the picture itself.
  Rgb colour_of(const VertexLight& light, bool is_whole) const {
    if (!(light.weight > 0)) return {};
    const Rgb irradiance = light.irradiance * (1 / light.weight), radiosity = light.radiosity * (1 / light.weight);
    const Rgb shown = tone_map(exposure_ * radiosity);
    if (is_whole) return shown;
    const auto band = [](double colour, double leaving, double arriving) {
      return leaving > 0 ? colour * arriving / leaving : 0;
    };
    return {band(shown.r, radiosity.r, irradiance.r), band(shown.g, radiosity.g, irradiance.g),
            band(shown.b, radiosity.b, irradiance.b)};
  }

  std::size_t unlit_material(const json& primitive, const json& material, bool is_whole) {
    constexpr std::size_t none = ~std::size_t{0};
    const auto [known, is_new] = materials_.try_emplace(index_in(primitive, "material", "primitive", none), 0);
    if (!is_new) return known->second;
    document_.use_extension("KHR_materials_unlit");
    json base = json::object();
    const json pbr = material.value("pbrMetallicRoughness", json::object());
    for (const char* kept : {"baseColorFactor", "baseColorTexture"})
      if (!is_whole && pbr.contains(kept)) base[kept] = pbr[kept];
    known->second = document_.append("materials", unlit(material, std::move(base)));
    return known->second;
  }

  GltfDocument document_;
  const Scene& scene_;
  double exposure_;
  SolvedSurface surface_;
  double dark_;  // W/m2
  PlacedMeshes meshes_;
  BakedSide side_;
  std::map<std::size_t, std::size_t> materials_;
  Baked baked_;
};

}  // namespace

Baked bake_vertices(GltfDocument document, const Scene& scene, const DisplayMesh& solution, BakedSide side) {
  return VertexBaker(std::move(document), scene, solution, side).bake();
}

}  // namespace alvor
