#include "client/bake/bake.h"

#include "client/bake/chart_layout.h"
#include "client/bake/exr_writer.h"
#include "client/bake/materials.h"
#include "client/bake/placed_meshes.h"
#include "client/bake/subdivision.h"
#include "client/bake/texels.h"
#include "client/bake/vertex_bake.h"
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
// Members of the file's extras.
constexpr const char *lightmap_key = "alvor_lightmap", *form_key = "alvor_baked_form";

class Baker {
 public:
  Baker(GltfDocument document, const Scene& scene, const DisplayMesh& solution, const BakeOptions& options,
        const ChartLayout& layout)
      : document_(std::move(document)),
        solution_(solution),
        options_(options),
        surface_(solution, scene),
        layout_(layout) {}

  Baked bake() {
    baked_.pages = pages_.count, baked_.texels_per_metre = pages_.texels_per_metre;
    choose_sides();
    fill_pages();
    write_pages();
    write_meshes();
    if (options_.form == BakeForm::lightmap && !options_.keeps_lights) drop_lights();
    describe();
    if (options_.with_errors) write_errors();
    baked_.glb = document_.encode();
    baked_.nodes = layout_.meshes.nodes.size();
    baked_.charts = charts_.size();
    return std::move(baked_);
  }

 private:
  void choose_sides() {
    tbb::parallel_for(std::size_t{0}, charts_.size(),
                      [&](std::size_t c) { sides_[c] = shown_side(charts_[c], surface_, options_.side); });
    baked_.lit_from_both = static_cast<std::size_t>(std::ranges::count_if(sides_, &ShownSide::loses_light));
  }

  /// Fills the rectangles of charts, which do not overlap.
  void fill_pages() {
    for (int p = 0; p < pages_.count; ++p) images_.emplace_back(pages_.size, options_.with_errors);
    const TexelValue value = value_of_texels();
    std::atomic<std::size_t> done = 0;
    double texels = 0;
    for (const ChartPlace& place : pages_.places) texels += double(place.wide) * place.high;
    tbb::parallel_for(std::size_t{0}, charts_.size(), [&](std::size_t c) {
      const ChartPlace& place = pages_.places[c];
      fill(images_[static_cast<std::size_t>(place.page)], charts_[c], place, pages_.padding, sides_[c].is_back, surface_, value);
      const std::size_t here = static_cast<std::size_t>(place.wide) * static_cast<std::size_t>(place.high);
      options_.on_progress(static_cast<double>(done += here) / texels);
    });
    if (options_.form == BakeForm::lightmap && options_.format == LightmapFormat::png) find_range();
    if (options_.with_errors) find_told_error();
    for (LightPage& page : images_) spread(page, {0, 0, 0, page.size, page.size}, spread_texels);
  }

  TexelValue value_of_texels() const {
    if (options_.form == BakeForm::unlit) {
      const double exposure = automatic_exposure(solution_);
      return [exposure](const SolvedSurface::Sample& sample) { return tone_map(exposure * sample.radiosity); };
    }
    return [factor = lightmap_factor()](const SolvedSurface::Sample& sample) { return factor * sample.irradiance; };
  }

  double lightmap_factor() const { return options_.unit == LightmapUnit::irradiance ? 1 : 1 / std::numbers::pi; }

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

  void find_told_error() {
    double light = 0, squares = 0, count = 0;
    for (const LightPage& page : images_)
      for (std::size_t t = 0; t < page.texels.size(); ++t) {
        if (!page.is_set[t]) continue;
        light += widen(page.texels[t]).mean(), squares += double(page.errors[t]) * page.errors[t], count += 1;
      }
    if (light > 0) baked_.told_error = lightmap_factor() * std::sqrt(squares * count) / light;
  }

  void write_errors() {
    const auto factor = static_cast<float>(lightmap_factor());
    for (std::size_t p = 0; p < images_.size(); ++p) {
      for (float& error : images_[p].errors) error *= factor;
      baked_.beside.push_back({error_file(p), encode_grey_exr(pages_.size, pages_.size, images_[p].errors)});
    }
  }

  std::string error_file(std::size_t page) const { return options_.name + "-error-" + std::to_string(page) + ".exr"; }

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

  void write_meshes() {
    std::size_t next = 0;
    rewrite_meshes(document_, layout_.meshes, [&](const MeshNode&, const PrimitiveCharts&, const json& primitive) {
      return written(layout_.primitives[next++], primitive);
    });
  }

  /// Returns a primitive with its texture coordinates, once for each page that its charts lie on.
  std::vector<json> written(const NodePrimitive& of, const json& original) {
    const ChartedMesh& charts = of.primitive->charts;
    std::vector<std::vector<MeshTriangle>> by_page(images_.size());
    for (std::size_t t = 0; t < charts.triangles.size(); ++t) {
      const std::uint32_t chart = charts.chart_of[t];
      const int page = chart == ChartedMesh::no_chart ? 0 : pages_.places[of.first_chart + chart].page;
      by_page[static_cast<std::size_t>(page)].push_back(charts.triangles[t]);
    }
    const json material = material_of(original, document_);
    json with_points = with_vertices(original, of);
    const std::size_t set = add_points(with_points, material, of);
    std::vector<json> primitives;
    for (std::size_t page = 0; page < by_page.size(); ++page) {
      if (by_page[page].empty()) continue;
      json primitive = with_points;
      const bool stays =
          charts.keeps_vertices(of.primitive->positions.size()) && by_page[page].size() == of.primitive->triangles.size();
      if (!stays) primitive["indices"] = document_.add_indices(by_page[page]), primitive["mode"] = glb::triangle_list;
      const bool keeps_material = textures_.empty() || (options_.form == BakeForm::unlit && shows_what_is_behind(material));
      if (!keeps_material) {
        primitive["material"] = material_with_light(original, page, set);
        if (options_.form == BakeForm::unlit) primitive["attributes"].erase("COLOR_0");  // the image has it
      }
      if (textures_.empty()) add_extra_to(primitive, "alvor_lightmap_file", page);
      if (options_.with_errors) add_extra_to(primitive, "alvor_lightmap_error_file", page);
      primitives.push_back(std::move(primitive));
    }
    return primitives;
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
    drop_compression(primitive);
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
    known->second = document_.add_accessor_like(accessor, bytes, charts.source.size());
    return known->second;
  }

  /// Adds the texture coordinates of the charts; returns their set. Set 1 if materials do not use it, as engines expect.
  std::size_t add_points(json& primitive, const json& material, const NodePrimitive& of) {
    const ChartedMesh& charts = of.primitive->charts;
    std::string bytes;
    for (std::size_t vertex = 0; vertex < charts.source.size(); ++vertex) {
      std::array<double, 2> at{0.5, 0.5};
      if (const std::uint32_t chart = charts.vertex_chart[vertex]; chart != ChartedMesh::no_chart)
        at = texel_of(charts_[of.first_chart + chart], pages_.places[of.first_chart + chart], pages_.padding,
                      static_cast<std::uint32_t>(vertex));
      for (const double texel : at) append_value(bytes, static_cast<float>(texel / pages_.size));
    }
    const std::size_t accessor = document_.add_accessor({{"componentType", glb::float_component}, {"type", "VEC2"}}, bytes,
                                                        charts.source.size(), glb::array_buffer);
    json& attributes = primitive["attributes"];
    std::size_t set = 1;
    while (options_.form == BakeForm::lightmap && uses_set(material, set)) ++set;
    for (std::size_t below = 0; below < set; ++below)  // sets have no gaps
      if (const std::string name = "TEXCOORD_" + std::to_string(below); !attributes.contains(name)) attributes[name] = accessor;
    attributes["TEXCOORD_" + std::to_string(set)] = accessor;
    return set;
  }

  /// Returns a copy of a primitive's material with the light of a page.
  std::size_t material_with_light(const json& primitive, std::size_t page, std::size_t set) {
    constexpr std::size_t none = ~std::size_t{0};
    const std::size_t original = index_in(primitive, "material", "primitive", none);
    const auto [known, is_new] = materials_.try_emplace({original, page, set}, 0);
    if (!is_new) return known->second;
    const json material = material_of(primitive, document_), texture{{"index", textures_[page]}, {"texCoord", set}};
    const bool is_lightmap = options_.form == BakeForm::lightmap;
    document_.use_extension(is_lightmap ? "MOZ_lightmap" : "KHR_materials_unlit");
    known->second = document_.append("materials", is_lightmap ? with_lightmap(material, texture, baked_.range)
                                                              : unlit(material, {{"baseColorTexture", texture}}));
    return known->second;
  }

  /// Removes the lamps, whose light is in the lightmap: viewers would add it once more.
  void drop_lights() {
    json& root = document_.root();
    for (const char* name : {"KHR_lights_punctual", "EXT_lights_ies"}) {
      const auto drop = [&](json& element) {
        if (!element.contains("extensions")) return;
        element["extensions"].erase(name);
        if (element["extensions"].empty()) element.erase("extensions");
      };
      drop(root);
      for (json& node : root["nodes"]) drop(node);
      for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        if (!root.contains(list)) continue;
        json kept = json::array();
        for (const json& used : root[list])
          if (used != name) kept.push_back(used);
        if (kept.empty()) root.erase(list);
        else root[list] = std::move(kept);
      }
    }
  }

  /// Says in the file what the light is.
  void describe() {
    if (options_.form == BakeForm::unlit) return document_.add_extra(form_key, "unlit");
    json said{{"quantity", options_.unit == LightmapUnit::irradiance ? "irradiance" : "irradiance over pi"},
              {"unit", solution_.quantity == Quantity::photometric ? "lx" : "W/m2"},
              {"texels_per_metre", pages_.texels_per_metre},
              {"size", pages_.size}};
    if (options_.format == LightmapFormat::png) said["encoding"] = "sRGB", said["range"] = baked_.range;
    for (const Baked::File& file : baked_.beside) said["files"].push_back(file.name);
    if (options_.with_errors) {
      for (std::size_t p = 0; p < images_.size(); ++p) said["error_files"].push_back(error_file(p));
      if (baked_.told_error) said["told_error"] = *baked_.told_error;
    }
    document_.add_extra(lightmap_key, std::move(said));
  }

  GltfDocument document_;
  const DisplayMesh& solution_;
  const BakeOptions& options_;
  SolvedSurface surface_;
  const ChartLayout& layout_;
  const std::vector<PlacedChart>& charts_ = layout_.charts;
  const ChartPages& pages_ = layout_.pages;
  std::vector<ShownSide> sides_{charts_.size()};  // by chart
  std::vector<LightPage> images_;
  std::optional<std::size_t> sampler_;
  std::vector<std::size_t> textures_;  // by page
  std::map<std::pair<std::size_t, const ChartedMesh*>, std::size_t> copies_;
  std::map<std::tuple<std::size_t, std::size_t, std::size_t>, std::size_t> materials_;
  Baked baked_;
};

/// Returns what `work` returns. Turns what JSON throws into BakeError.
template <class Work>
auto baking(Work work) {
  try {
    return work();
  } catch (const json::exception&) {
    throw BakeError("file", "is not as glTF says: a member has another type or is missing");
  } catch (const std::out_of_range&) {
    throw BakeError("file", "is not as glTF says: an index is out of range");
  }
}

/// Throws BakeError if a file has baked light, which would pass for its colours.
void refuse_baked(const GltfDocument& document) {
  const json extras = document.root().value("extras", json());
  for (const char* key : {lightmap_key, form_key})
    if (extras.is_object() && extras.contains(key))
      throw BakeError("extras." + std::string(key), "light is baked into this file: bake the one that it was made of");
}

}  // namespace

std::shared_ptr<const ChartLayout> lay_out(const GltfDocument& document, const Scene& scene, const BakeOptions& options) {
  return baking([&]() -> std::shared_ptr<const ChartLayout> {
    refuse_baked(document);
    if (options.form == BakeForm::vertex) return nullptr;
    return std::make_shared<const ChartLayout>(document, scene, options);
  });
}

Baked bake(GltfDocument document, const Scene& scene, const DisplayMesh& solution, const BakeOptions& options,
           std::shared_ptr<const ChartLayout> layout) {
  if (options.with_errors && solution.errors.empty()) throw BakeError("solution", "tells no errors");
  if (!layout) layout = lay_out(document, scene, options);
  return baking([&] {
    for (const auto& [name, extra] : options.extras.items()) document.add_extra(name, extra);
    if (options.form == BakeForm::vertex) {
      document.add_extra(form_key, "vertex");
      if (options.longest_edge) subdivide(document, *options.longest_edge);
      return bake_vertices(std::move(document), scene, solution, options.side);
    }
    return Baker(std::move(document), scene, solution, options, *layout).bake();
  });
}

}  // namespace alvor
