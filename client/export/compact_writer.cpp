// Writes compact solution files.

#include "client/export/compact_file.h"
#include "client/export/part_stream.h"
#include "client/export/solution_file.h"
#include "meshing/present_objects.h"
#include "proto/codec.h"
#include "proto/leaf_codec.h"
#include "proto/mesh_codec.h"

#include <algorithm>

namespace alvor {

namespace {

/// Writes the parts of one solution.
class Writer {
 public:
  Writer(const BaseMesh& mesh, std::span<const LeafValue> leaves) : mesh_(mesh), leaves_(leaves) {}

  std::string write(std::span<const float> errors) {
    bytes_ = compact_magic;
    add_header(!errors.empty());
    add_images();
    add_mesh();
    add_surroundings();
    add_leaves();
    if (!errors.empty()) add_errors(errors);
    if (leaves_.size() > leaves_at_least + leaves_per_byte * bytes_.size())
      throw SolutionFileError("the values are too much alike for so many leaves: write .glb");
    return std::move(bytes_);
  }

 private:
  void add_header(bool has_errors) {
    v1::SolutionPart part;
    const bool has_slabs = std::ranges::any_of(leaves_, [](const LeafValue& leaf) { return leaf.patch.has_slabs(); });
    part.mutable_header()->set_version(has_slabs ? newest_version : without_slabs);
    part.mutable_header()->set_root_count(mesh_.roots().size());
    part.mutable_header()->set_leaf_count(leaves_.size());
    part.mutable_header()->set_has_errors(has_errors);
    append_part(bytes_, part);
  }

  void add_images() {
    MeshImageSlicer slicer(mesh_.materials());
    for (v1::ReadImagesResponse images; slicer.next(images);) {
      v1::SolutionPart part;
      *part.mutable_images() = compressed(images);
      append_part(bytes_, part);
    }
  }

  void add_mesh() {
    MeshSlicer slicer(mesh_);
    for (v1::ReadMeshResponse mesh; slicer.next(mesh);) {
      v1::SolutionPart part;
      *part.mutable_mesh() = compressed(mesh);
      append_part(bytes_, part);
    }
  }

  void add_surroundings() {
    Scene scene;
    scene.absorption = mesh_.absorption();
    scene.lights = present_lights(mesh_.lights());
    scene.objects.assign(mesh_.objects().begin(), mesh_.objects().end());
    SceneSlicer slicer(scene);
    for (v1::GeometryChunk chunk; slicer.next(chunk);) {
      v1::SolutionPart part;
      *part.mutable_surroundings() = compressed(chunk);
      append_part(bytes_, part);
    }
  }

  void add_leaves() {
    float largest = 0;
    for (const LeafValue& leaf : leaves_) largest = std::max(largest, leaf.irradiance.max());
    const SharedExponent coding = largest > 0 ? SharedExponent::for_values_up_to(largest) : SharedExponent(0);
    for (std::size_t first = 0; first < leaves_.size(); first += leaves_per_frame(Detail::display)) {
      const std::size_t count = std::min(leaves_per_frame(Detail::display), leaves_.size() - first);
      v1::SolutionPart part;
      *part.mutable_leaves() = encode_leaves(leaves_.subspan(first, count), Detail::display, coding);
      append_part(bytes_, part);
    }
  }

  void add_errors(std::span<const float> errors) {
    const ErrorCoding coding = ErrorCoding::for_errors_up_to(std::ranges::max(errors));
    for (std::size_t first = 0; first < errors.size(); first += most_errors_per_frame) {
      const std::size_t count = std::min(most_errors_per_frame, errors.size() - first);
      ErrorPage page{leaves_[first].patch, coding, {}};
      for (const float error : errors.subspan(first, count)) page.codes.push_back(coding.pack(error));
      v1::SolutionPart part;
      *part.mutable_errors() = encode_errors(page);
      append_part(bytes_, part);
    }
  }

  const BaseMesh& mesh_;
  const std::span<const LeafValue> leaves_;
  std::string bytes_;
};

/// Returns the roots of a mesh that are not hidden, backs of two-sided faces last, as in the mesh that decode_compact() makes.
std::vector<std::uint32_t> roots_in_order(const BaseMesh& mesh) {
  std::vector<std::uint32_t> order;
  for (const bool backs : {false, true})
    for (std::uint32_t r = 0; r < mesh.roots().size(); ++r)
      if (!mesh.roots()[r].is_hidden && mesh.roots()[r].is_back == backs) order.push_back(r);
  return order;
}

/// Leaves and their errors, if any.
struct LeavesOfFile {
  std::vector<LeafValue> leaves;
  std::vector<float> errors;
};

/// Returns the leaves of some roots, numbered by their places in the list. Requires: `leaves` are sorted.
LeavesOfFile leaves_of(std::span<const std::uint32_t> order, std::span<const LeafValue> leaves, std::span<const float> errors) {
  LeavesOfFile file;
  const auto root_of = [](const LeafValue& leaf) { return leaf.patch.root_face(); };
  for (std::uint32_t n = 0; n < order.size(); ++n) {
    const auto first = std::ranges::lower_bound(leaves, order[n], {}, root_of);
    for (auto leaf = first; leaf != leaves.end() && root_of(*leaf) == order[n]; ++leaf) {
      file.leaves.push_back({leaf->patch.of_root(n), leaf->irradiance});
      if (!errors.empty()) file.errors.push_back(errors[static_cast<std::size_t>(leaf - leaves.begin())]);
    }
  }
  return file;
}

}  // namespace

std::string encode_compact(const BaseMesh& mesh, std::span<const LeafValue> leaves, std::span<const float> errors) {
  const auto order = roots_in_order(mesh);
  if (order.empty()) throw SolutionFileError("mesh: has no surface, or edits have taken all of it away");
  if (order.size() == mesh.roots().size() && std::ranges::is_sorted(order)) return Writer(mesh, leaves).write(errors);
  const LeavesOfFile file = leaves_of(order, leaves, errors);
  return Writer(mesh.with_roots(order), file.leaves).write(file.errors);
}

}  // namespace alvor
