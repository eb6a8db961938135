#pragma once
// The charts of all nodes of a file, and their places on the pages of its lightmap. Known before anything is solved.

#include "client/bake/bake.h"
#include "client/bake/chart_pages.h"
#include "client/bake/placed_meshes.h"
#include "client/bake/texels.h"

#include <cstddef>
#include <vector>

namespace alvor {

/// A primitive of a node's mesh: its charts are those from first_chart on.
struct NodePrimitive {
  const MeshNode* node;
  const PrimitiveCharts* primitive;
  std::size_t first_chart;
};

/// Its parts borrow from each other: it is not copied.
struct ChartLayout {
  /// Requires: `document` is the file that `scene` was read from, or document_of() it. Throws BakeError, also where the charts do
  /// not fit.
  ChartLayout(const GltfDocument& document, const Scene& scene, const BakeOptions& options);
  ChartLayout(const ChartLayout&) = delete;
  ChartLayout& operator=(const ChartLayout&) = delete;

  PlacedMeshes meshes;
  std::vector<NodePrimitive> primitives;
  std::vector<PlacedChart> charts;
  ChartPages pages;
};

}  // namespace alvor
