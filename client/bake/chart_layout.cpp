#include "client/bake/chart_layout.h"

#include "client/bake/materials.h"

#include <string>

namespace alvor {

namespace {

// Packing takes 20 s for so many, and no engine wants them.
constexpr std::size_t most_charts = 1'000'000;

ChartPages pages_of(std::span<const PlacedChart> charts, const BakeOptions& options) {
  std::vector<ChartSize> sizes;
  for (const PlacedChart& chart : charts) sizes.push_back(size_of(chart));
  if (auto pages = place_charts(sizes, {options.size, options.padding, options.texels_per_metre})) return *std::move(pages);
  throw BakeError("file", "its " + std::to_string(charts.size()) + " charts do not fit textures of " +
                              std::to_string(options.size) + " x " + std::to_string(options.size) +
                              (options.texels_per_metre ? ": ask for larger textures, fewer texels per metre or less padding"
                                                        : ": ask for larger textures or less padding"));
}

}  // namespace

ChartLayout::ChartLayout(const GltfDocument& document, const Scene& scene, const BakeOptions& options)
    : meshes(placed_meshes(document)) {
  check_objects(meshes, scene);
  for (const MeshNode& node : meshes.nodes)
    for (const PrimitiveCharts& primitive : meshes.primitives.at(node.mesh)) {
      primitives.push_back({&node, &primitive, charts.size()});
      const bool may_show_back =
          is_two_sided(document.element("meshes", node.mesh).at("primitives").at(primitive.primitive), document);
      for (const Chart& chart : primitive.charts.charts)
        charts.push_back(
            {primitive.positions, &primitive.charts, &chart, to_scene(scene) * node.placement, node.object, may_show_back});
    }
  if (charts.empty()) throw BakeError("file", "shows no surface");
  if (charts.size() > most_charts)
    throw BakeError("file", "falls into " + std::to_string(charts.size()) + " charts, more than " + std::to_string(most_charts) +
                                ": join the vertices of its faces");
  pages = pages_of(charts, options);
}

}  // namespace alvor
