#include "client/bake/bake.h"

#include "client/bake/exr_writer.h"
#include "client/bake/placed_meshes.h"
#include "client/bake/texels.h"
#include "client/picture/png_file.h"
#include "client/picture/tone_map.h"
#include "client/picture/units.h"
#include "import/base/bytes.h"
#include "import/base/glb_format.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <tuple>

namespace alvor {

namespace {

using nlohmann::json;

// Share of the texels of charts that may be brighter than a PNG's range, which is then not wasted on the inside of lamps.
constexpr double clipped_at_most = 0.002;
// Texels that unused parts of a page take from their neighbours, so that two smaller mip levels hold no black. Chosen.
constexpr int spread_texels = 8;

/// A chart of a node's mesh, and its place among the textures.
struct NodeChart {
  PlacedChart placed;
  ShownSide side;
};

/// A primitive of a node's mesh: its charts are those from first_chart on.
struct NodePrimitive {
  const MeshNode* node;
  const PrimitiveCharts* primitive;
  std::size_t first_chart;
};

bool is_two_sided(const json& primitive, const GltfDocument& document) {
  const auto material = primitive.find("material");
  if (material == primitive.end() || !is_index(*material)) return false;
  return document.element("materials", material->get<std::size_t>()).value("doubleSided", false);
}

/// Returns the map from a document's coordinates to those of the scene that it was made from or read as.
Placement to_scene(const Scene& scene) {
  if (scene.up == UpAxis::y) return {};
  return {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {}};
}

class Baker {
 public:
  Baker(GltfDocument document, const Scene& scene, const DisplayMesh& solution, const BakeOptions& options)
      : document_(std::move(document)),
        scene_(scene),
        solution_(solution),
        options_(options),
        surface_(solution, scene.objects, scene.faces.size()),
        meshes_(placed_meshes(document_)) {}

  Baked bake() {
    check_objects();
    collect_charts();
    place();
    choose_sides();
    fill_pages();
    write_pages();
    write_meshes();
    describe();
    baked_.glb = document_.encode();
    baked_.nodes = meshes_.nodes.size();
    baked_.charts = charts_.size();
    return std::move(baked_);
  }

 private:
  /// Checks that nodes are the scene's objects. The faces of no object come last.
  void check_objects() const {
    const std::size_t objects = scene_.objects.size(), visited = meshes_.visited;
    if (visited != objects && visited != objects + 1)
      throw BakeError("file", "its scene shows " + std::to_string(visited) + " nodes, but the solved scene has " +
                                  std::to_string(objects) + " objects");
  }

  void collect_charts() {
    for (const MeshNode& node : meshes_.nodes)
      for (const PrimitiveCharts& primitive : meshes_.primitives.at(node.mesh)) {
        primitives_.push_back({&node, &primitive, charts_.size()});
        const bool may_show_back = is_two_sided(primitive_of(node.mesh, primitive.primitive), document_);
        for (const Chart& chart : primitive.charts.charts)
          charts_.push_back({{primitive.positions, &primitive.charts, &chart, to_scene(scene_) * node.placement, node.object,
                              may_show_back},
                             {}});
      }
    if (charts_.empty()) throw BakeError("file", "shows no surface");
  }

  const json& primitive_of(std::size_t mesh, std::size_t primitive) const {
    return document_.element("meshes", mesh).at("primitives").at(primitive);
  }

  void place() {
    std::vector<ChartSize> sizes;
    for (const NodeChart& chart : charts_) sizes.push_back(size_of(chart.placed));
    auto pages = place_charts(sizes, {options_.size, options_.padding, options_.texels_per_metre});
    if (!pages)
      throw BakeError("file", "its " + std::to_string(charts_.size()) + " charts do not fit textures of " +
                                  std::to_string(options_.size) + " x " + std::to_string(options_.size) +
                                  (options_.texels_per_metre ? ": ask for larger textures or fewer texels per metre"
                                                             : ": ask for larger textures"));
    pages_ = *std::move(pages);
    baked_.pages = pages_.count, baked_.texels_per_metre = pages_.texels_per_metre;
  }

  void choose_sides() {
    tbb::parallel_for(std::size_t{0}, charts_.size(),
                      [&](std::size_t c) { charts_[c].side = brighter_side(charts_[c].placed, surface_); });
    baked_.lit_from_both = static_cast<std::size_t>(
        std::ranges::count_if(charts_, [](const NodeChart& chart) { return chart.side.loses_light; }));
  }

  /// Fills the rectangles of charts, which do not overlap.
  void fill_pages() {
    for (int p = 0; p < pages_.count; ++p) images_.emplace_back(pages_.size);
    const TexelValue value = value_of_texels();
    std::atomic<std::size_t> done = 0;
    double texels = 0;
    for (const ChartPlace& place : pages_.places) texels += double(place.wide) * place.high;
    tbb::parallel_for(std::size_t{0}, charts_.size(), [&](std::size_t c) {
      const ChartPlace& place = pages_.places[c];
      fill(images_[static_cast<std::size_t>(place.page)], charts_[c].placed, place, pages_.padding, charts_[c].side.is_back,
           surface_, value);
      const std::size_t here = static_cast<std::size_t>(place.wide) * static_cast<std::size_t>(place.high);
      options_.on_progress(static_cast<double>(done += here) / texels);
    });
    if (options_.form == BakeForm::lightmap && options_.format == LightmapFormat::png) find_range();
    for (LightPage& page : images_) spread(page, spread_texels);
  }

  TexelValue value_of_texels() const {
    if (options_.form == BakeForm::unlit) {
      const double exposure = automatic_exposure(solution_);
      return [exposure](const SolvedSurface::Sample& sample) { return tone_map(exposure * sample.radiosity); };
    }
    const double factor = options_.unit == LightmapUnit::irradiance ? 1 : 1 / std::numbers::pi;
    return [factor](const SolvedSurface::Sample& sample) { return factor * sample.irradiance; };
  }

  void find_range() {
    std::vector<float> most;
    for (const LightPage& page : images_)
      for (std::size_t t = 0; t < page.texels.size(); ++t)
        if (page.is_set[t]) most.push_back(std::max({page.texels[t].r, page.texels[t].g, page.texels[t].b}));
    std::ranges::sort(most);
    double range = options_.range.value_or(0);
    if (!options_.range && !most.empty())
      range = most[static_cast<std::size_t>((1 - clipped_at_most) * static_cast<double>(most.size() - 1))];
    baked_.range = range > 0 ? range : 1;
    const auto clipped = most.end() - std::ranges::upper_bound(most, static_cast<float>(baked_.range));
    baked_.clipped_share = most.empty() ? 0 : static_cast<double>(clipped) / static_cast<double>(most.size());
  }

  void write_pages() {
    for (std::size_t p = 0; p < images_.size(); ++p) {
      const std::string number = "-" + std::to_string(p);
      if (options_.form == BakeForm::lightmap && options_.format == LightmapFormat::exr) {
        baked_.beside.push_back({options_.name + number + ".exr", encode_exr(pages_.size, pages_.size, images_[p].texels)});
        continue;
      }
      const double scale = options_.form == BakeForm::lightmap ? 1 / baked_.range : 1;
      Image image{pages_.size, pages_.size, {}, false};
      for (const RgbF& texel : images_[p].texels)
        for (const float band : {texel.r, texel.g, texel.b}) image.rgb.push_back(srgb_byte(scale * band));
      const std::size_t source = document_.add_png(encode_png(image, "texture"), "light" + number);
      if (!sampler_) sampler_ = document_.append("samplers", sampler());
      textures_.push_back(document_.append("textures", {{"source", source}, {"sampler", *sampler_}, {"name", "light" + number}}));
    }
  }

  /// Light is smooth and needs no mip levels, the smallest of which would mix charts; colours of images do.
  json sampler() const {
    constexpr int linear = 9729, linear_mipmap_linear = 9987;
    return {{"magFilter", linear},
            {"minFilter", options_.form == BakeForm::lightmap ? linear : linear_mipmap_linear},
            {"wrapS", glb::clamp_to_edge},
            {"wrapT", glb::clamp_to_edge}};
  }

  /// Gives each node a mesh of its own. A primitive whose charts lie on several pages becomes several.
  void write_meshes() {
    std::size_t next = 0;
    for (const MeshNode& node : meshes_.nodes) {
      json mesh = document_.element("meshes", node.mesh);
      json primitives = json::array();
      for (std::size_t p = 0; p < mesh.at("primitives").size(); ++p) {
        const bool is_baked = next < primitives_.size() && primitives_[next].node == &node && primitives_[next].primitive->primitive == p;
        if (is_baked) write_primitive(primitives_[next++], primitives);
        else primitives.push_back(mesh["primitives"][p]);
      }
      mesh["primitives"] = std::move(primitives);
      const std::size_t number = document_.append("meshes", std::move(mesh));
      document_.root()["nodes"][node.node]["mesh"] = number;
    }
    drop_unused_meshes();
  }

  void write_primitive(const NodePrimitive& of, json& primitives) {
    const json original = primitive_of(of.node->mesh, of.primitive->primitive);
    const ChartedMesh& charts = of.primitive->charts;
    std::vector<std::vector<MeshTriangle>> by_page(images_.size());
    for (std::size_t t = 0; t < charts.triangles.size(); ++t) {
      const std::uint32_t chart = charts.chart_of[t];
      const int page = chart == ChartedMesh::no_chart ? 0 : pages_.places[of.first_chart + chart].page;
      by_page[static_cast<std::size_t>(page)].push_back(charts.triangles[t]);
    }
    json with_points = with_vertices(original, of);
    const std::size_t set = add_points(with_points, of);
    for (std::size_t page = 0; page < by_page.size(); ++page) {
      if (by_page[page].empty()) continue;
      json primitive = with_points;
      const bool stays = charts.keeps_vertices(of.primitive->positions.size()) &&
                         by_page[page].size() == of.primitive->triangles.size();
      if (!stays) {
        primitive["indices"] = indices_of(by_page[page]);
        primitive["mode"] = 4;
      }
      if (const auto material = material_with_light(original, page, set)) {
        primitive["material"] = *material;
        if (options_.form == BakeForm::unlit) primitive["attributes"].erase("COLOR_0");  // the image has it
      }
      primitives.push_back(std::move(primitive));
    }
  }

  std::size_t indices_of(std::span<const MeshTriangle> triangles) {
    std::string bytes;
    for (const MeshTriangle& triangle : triangles)
      for (const std::uint32_t vertex : triangle) append_value(bytes, vertex);
    return document_.add_accessor({{"componentType", glb::uint_component}, {"type", "SCALAR"}}, bytes, 3 * triangles.size(),
                                  glb::element_array_buffer);
  }

  /// Returns a primitive whose vertices are those of the charts: the same if the charts have none in common.
  json with_vertices(json primitive, const NodePrimitive& of) {
    const ChartedMesh& charts = of.primitive->charts;
    if (charts.keeps_vertices(of.primitive->positions.size())) return primitive;
    const auto copy = [&](json& attributes) {
      for (json& accessor : attributes) accessor = copied(accessor.get<std::size_t>(), charts);
    };
    copy(primitive.at("attributes"));
    if (primitive.contains("targets"))
      for (json& target : primitive["targets"]) copy(target);
    if (primitive.contains("extensions")) {
      primitive["extensions"].erase("KHR_draco_mesh_compression");
      if (primitive["extensions"].empty()) primitive.erase("extensions");
    }
    return primitive;
  }

  /// Returns an accessor with the elements of `accessor` for each vertex of the charts. Nodes that show one mesh share it.
  std::size_t copied(std::size_t accessor, const ChartedMesh& charts) {
    const auto [known, is_new] = copies_.try_emplace({accessor, &charts}, 0);
    if (!is_new) return known->second;
    const DenseElements elements = document_.read(accessor);
    std::string bytes;
    for (const std::uint32_t vertex : charts.source) {
      if (vertex >= elements.count) throw BakeError("accessor " + std::to_string(accessor), "has fewer elements than POSITION");
      bytes += elements.at(vertex);
    }
    const json like = document_.element("accessors", accessor);
    known->second = document_.add_accessor(like, bytes, charts.source.size(), glb::array_buffer);
    json& made = document_.root()["accessors"][known->second];
    for (const char* bound : {"min", "max"})  // the same elements, some of them twice
      if (like.contains(bound)) made[bound] = like[bound];
    return known->second;
  }

  /// Adds the texture coordinates of the charts; returns their set. Set 1 if materials do not use it, as engines expect.
  std::size_t add_points(json& primitive, const NodePrimitive& of) {
    const ChartedMesh& charts = of.primitive->charts;
    std::string bytes;
    for (std::size_t vertex = 0; vertex < charts.source.size(); ++vertex) {
      std::array<double, 2> at{0.5, 0.5};
      if (const std::uint32_t chart = charts.vertex_chart[vertex]; chart != ChartedMesh::no_chart)
        at = texel_of(charts_[of.first_chart + chart].placed, pages_.places[of.first_chart + chart], pages_.padding,
                      static_cast<std::uint32_t>(vertex));
      for (const double texel : at) append_value(bytes, static_cast<float>(texel / pages_.size));
    }
    const std::size_t accessor = document_.add_accessor({{"componentType", glb::float_component}, {"type", "VEC2"}}, bytes,
                                                        charts.source.size(), glb::array_buffer);
    json& attributes = primitive["attributes"];
    std::size_t set = 1;
    while (uses_set(primitive, set)) ++set;
    for (std::size_t below = 0; below < set; ++below)  // sets have no gaps
      if (const std::string name = "TEXCOORD_" + std::to_string(below); !attributes.contains(name)) attributes[name] = accessor;
    attributes["TEXCOORD_" + std::to_string(set)] = accessor;
    return set;
  }

  /// Returns whether the material of a primitive has a texture, other than one of light, that lies by a set of coordinates.
  bool uses_set(const json& primitive, std::size_t set) const {
    if (options_.form == BakeForm::unlit || !primitive.contains("material")) return false;
    const json& material = document_.element("materials", primitive["material"].get<std::size_t>());
    std::vector<const json*> stack{&material};
    while (!stack.empty()) {
      const json& next = *stack.back();
      stack.pop_back();
      if (next.is_object() && next.contains("texCoord") && next["texCoord"] == set) return true;
      for (const auto& [key, member] : next.items())
        if (member.is_structured() && key != "MOZ_lightmap") stack.push_back(&member);  // light of an earlier bake goes
    }
    return false;
  }

  /// Returns a copy of a primitive's material with the light of a page; nothing if it keeps its own.
  std::optional<std::size_t> material_with_light(const json& primitive, std::size_t page, std::size_t set) {
    if (textures_.empty()) return std::nullopt;
    const std::optional<std::size_t> original =
        primitive.contains("material") ? std::optional(primitive["material"].get<std::size_t>()) : std::nullopt;
    if (original && options_.form == BakeForm::unlit && shows_what_is_behind(document_.element("materials", *original)))
      return std::nullopt;
    const auto [known, is_new] = materials_.try_emplace({original.value_or(~std::size_t{0}), page, set}, 0);
    if (!is_new) return known->second;
    json material = original ? document_.element("materials", *original) : json::object();
    const json texture{{"index", textures_[page]}, {"texCoord", set}};
    if (options_.form == BakeForm::lightmap) {
      json light = texture;
      light["intensity"] = baked_.range;
      material["extensions"]["MOZ_lightmap"] = std::move(light);
      use_extension("MOZ_lightmap");
    } else {
      material = unlit(material, texture);
      use_extension("KHR_materials_unlit");
    }
    known->second = document_.append("materials", std::move(material));
    return known->second;
  }

  /// Returns whether one sees through a material where its image or glass says so, which an image of colours cannot show.
  static bool shows_what_is_behind(const json& material) {
    const bool has_image = material.contains("pbrMetallicRoughness") && material["pbrMetallicRoughness"].contains("baseColorTexture");
    const bool has_alpha = material.value("alphaMode", "OPAQUE") != "OPAQUE";
    const bool is_glass = material.contains("extensions") && material["extensions"].contains("KHR_materials_transmission");
    return (has_alpha && has_image) || is_glass;
  }

  static json unlit(const json& material, const json& texture) {
    json made{{"pbrMetallicRoughness", {{"baseColorTexture", texture}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
              {"extensions", {{"KHR_materials_unlit", json::object()}}}};
    for (const char* kept : {"name", "extras", "doubleSided", "alphaMode", "alphaCutoff"})
      if (material.contains(kept)) made[kept] = material[kept];
    if (made.contains("alphaMode") && material.contains("pbrMetallicRoughness")) {
      const json factor = material["pbrMetallicRoughness"].value("baseColorFactor", json::array({1, 1, 1, 1}));
      made["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, factor.at(3)};
    }
    return made;
  }

  void use_extension(const char* name) {
    json& used = document_.root()["extensionsUsed"];
    if (std::ranges::find(used, name) == used.end()) used.push_back(name);
  }

  /// Removes the meshes that no node shows any longer.
  void drop_unused_meshes() {
    json& meshes = document_.root()["meshes"];
    std::vector<std::size_t> number(meshes.size(), ~std::size_t{0});
    json kept = json::array();
    for (json& node : document_.root()["nodes"]) {
      if (!node.contains("mesh")) continue;
      const auto mesh = node["mesh"].get<std::size_t>();
      if (mesh >= number.size()) throw BakeError("mesh " + std::to_string(mesh), "is not in the file");
      if (number[mesh] == ~std::size_t{0}) {
        number[mesh] = kept.size();
        kept.push_back(meshes[mesh]);
      }
      node["mesh"] = number[mesh];
    }
    meshes = std::move(kept);
  }

  /// Says in the file what the light is.
  void describe() {
    if (options_.form == BakeForm::unlit) return;
    json said{{"quantity", options_.unit == LightmapUnit::irradiance ? "irradiance" : "irradiance over pi"},
              {"unit", solution_.quantity == Quantity::photometric ? "lx" : "W/m2"},
              {"texels_per_metre", pages_.texels_per_metre},
              {"size", pages_.size}};
    if (options_.format == LightmapFormat::png) said["encoding"] = "sRGB", said["range"] = baked_.range;
    for (const Baked::File& file : baked_.beside) said["files"].push_back(file.name);
    json& extras = document_.root()["extras"];
    if (!extras.is_object() && !extras.is_null()) extras = {{"extras", extras}};
    extras["alvor_lightmap"] = std::move(said);
  }

  GltfDocument document_;
  const Scene& scene_;
  const DisplayMesh& solution_;
  const BakeOptions& options_;
  SolvedSurface surface_;
  PlacedMeshes meshes_;
  std::vector<NodePrimitive> primitives_;
  std::vector<NodeChart> charts_;
  ChartPages pages_;
  std::vector<LightPage> images_;
  std::optional<std::size_t> sampler_;
  std::vector<std::size_t> textures_;  // by page
  std::map<std::pair<std::size_t, const ChartedMesh*>, std::size_t> copies_;
  std::map<std::tuple<std::size_t, std::size_t, std::size_t>, std::size_t> materials_;
  Baked baked_;
};

}  // namespace

Baked bake(GltfDocument document, const Scene& scene, const DisplayMesh& solution, const BakeOptions& options) {
  try {
    return Baker(std::move(document), scene, solution, options).bake();
  } catch (const nlohmann::json::exception&) {
    throw BakeError("file", "is not as glTF says: a member has another type or is missing");
  } catch (const std::out_of_range&) {
    throw BakeError("file", "is not as glTF says: an index is out of range");
  }
}

}  // namespace alvor
