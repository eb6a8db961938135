#include "client/export/compact_file.h"

#include "client/export/part_stream.h"
#include "client/export/solution_file.h"
#include "client/export/vertex_index.h"
#include "meshing/present_objects.h"
#include "proto/codec.h"
#include "proto/leaf_codec.h"
#include "proto/mesh_codec.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace alvor {

namespace {

/// Collects the parts of a file.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : parts_(bytes), most_leaves_(leaves_at_least + leaves_per_byte * bytes.size()) {}

  DisplayMesh read() {
    read_header();
    while (const auto part = parts_.next()) add(*part);
    const BaseMesh mesh = base_mesh();
    check_leaves(mesh);
    DisplayMesh display = build_display_mesh(mesh, leaves_, errors_);
    name_parts(display);
    return display;
  }

 private:
  /// Replaces the objects and faces of the scene that was rebuilt by those of the scene that was solved which are there.
  void name_parts(DisplayMesh& display) const {
    check_objects(objects_);
    const PresentObjects present(objects_);
    std::vector<FaceTriangles> faces;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (auto first = display.triangles.cbegin(); const FaceTriangles& run : display.faces) {
      const auto last = first + run.count;
      if (const InputFaces& source = sources_[run.faces.first]; present.has(source.first)) {
        append_run(faces, {present.numbers_of(source), run.material, run.count});
        triangles.insert(triangles.end(), first, last);
      }
      first = last;
    }
    display.faces = std::move(faces);
    display.triangles = std::move(triangles);
    display.objects = present.objects();
  }

  void read_header() {
    const auto part = parts_.next();
    if (!part || !part->has_header()) parts_.fail("the header is missing");
    header_ = part->header();
    if (header_.version() < without_slabs || header_.version() > newest_version)
      parts_.fail("version " + std::to_string(header_.version()) + " is not known: a newer program wrote the file");
    if (header_.root_count() > PatchId::most_roots) parts_.fail("more root patches than there can be");
    if (header_.leaf_count() > most_leaves_) parts_.fail("more leaves than a file of this size can hold");
  }

  void add(const v1::SolutionPart& part) {
    switch (part.part_case()) {
      case v1::SolutionPart::kImages: return add_images(part.images());
      case v1::SolutionPart::kMesh: return add_mesh(part.mesh());
      case v1::SolutionPart::kSurroundings: return add_surroundings(part.surroundings());
      case v1::SolutionPart::kLeaves: return add_leaves(part.leaves());
      case v1::SolutionPart::kErrors: return add_errors(part.errors());
      default: parts_.fail("of no known kind");
    }
  }

  void add_chunk(const v1::GeometryChunk& chunk) {
    if (const auto fault = scene_.add(chunk)) parts_.fail(fault->text());
  }

  void add_images(const v1::CompressedMessage& packed) {
    v1::ReadImagesResponse images;
    parts_.unpack(packed, images);
    v1::GeometryChunk chunk;
    chunk.mutable_images()->Swap(images.mutable_images());
    chunk.set_texels(std::move(*images.mutable_texels()));
    add_chunk(chunk);
  }

  void add_mesh(const v1::CompressedMessage& packed) {
    v1::ReadMeshResponse mesh;
    parts_.unpack(packed, mesh);
    v1::GeometryChunk materials;
    materials.mutable_materials()->Swap(mesh.mutable_scene_materials());
    materials.set_up_axis(mesh.up_axis());
    materials.set_quantity(mesh.quantity());
    add_chunk(materials);
    check_sizes(mesh);
    v1::GeometryChunk chunk;
    int corner = 0;
    for (int root = 0; root < mesh.corner_counts_size(); corner += static_cast<int>(mesh.corner_counts(root)), ++root)
      if (is_front(mesh.materials(root))) add_root(mesh, root, corner, chunk);
    add_chunk(chunk);
  }

  /// Throws unless the lists of a message have the same lengths.
  void check_sizes(const v1::ReadMeshResponse& mesh) const {
    std::uint64_t corners = 0;
    for (const std::uint32_t count : mesh.corner_counts()) {
      if (count != 3 && count != 4) parts_.fail("a root patch has neither three nor four corners");
      corners += count;
    }
    const auto is = [](int size, std::uint64_t count) { return static_cast<std::uint64_t>(size) == count; };
    const auto is_none_or = [&](int size, std::uint64_t count) { return size == 0 || is(size, count); };
    const auto roots = static_cast<std::uint64_t>(mesh.corner_counts_size());
    if (!is(mesh.materials_size(), roots) || !is(mesh.scene_faces_size(), roots) || !is(mesh.second_scene_faces_size(), roots) ||
        !is(mesh.corner_coordinates_size(), 3 * corners) || !is_none_or(mesh.texture_coordinates_size(), 2 * corners) ||
        !is_none_or(mesh.corner_colors_size(), 3 * corners))
      parts_.fail("its lists are not equally long");
  }

  /// Returns whether the next root is no back of a two-sided face: those come after all others, and are made again.
  bool is_front(std::uint32_t material) {
    if (fronts_ + backs_ >= header_.root_count()) return false;
    const auto& materials = scene_.scene().materials;
    if (material >= materials.size()) parts_.fail("a root patch has no material");
    ++fronts_;
    backs_ += materials[material].two_sided;
    return true;
  }

  void add_root(const v1::ReadMeshResponse& mesh, int root, int corner, v1::GeometryChunk& chunk) {
    const int count = static_cast<int>(mesh.corner_counts(root));
    chunk.add_face_corner_counts(mesh.corner_counts(root));
    chunk.add_face_materials(mesh.materials(root));
    const std::uint32_t second = mesh.second_scene_faces(root);
    sources_.push_back({mesh.scene_faces(root), second == 0 ? InputFaces::none : second - 1});
    for (int c = corner; c < corner + count; ++c) {
      const Vec3 place{mesh.corner_coordinates(3 * c), mesh.corner_coordinates(3 * c + 1), mesh.corner_coordinates(3 * c + 2)};
      const auto [vertex, is_new] = vertices_.find_or_add(place);
      chunk.add_corner_vertices(vertex);
      if (is_new)
        for (const double x : {place.x, place.y, place.z}) chunk.add_vertex_coordinates(x);
      for (int k = 2 * c; k < 2 * c + 2 && mesh.texture_coordinates_size() > 0; ++k)
        chunk.add_texture_coordinates(mesh.texture_coordinates(k));
      for (int k = 3 * c; k < 3 * c + 3 && mesh.corner_colors_size() > 0; ++k) chunk.add_corner_colors(mesh.corner_colors(k));
    }
  }

  void add_surroundings(const v1::CompressedMessage& packed) {
    v1::GeometryChunk chunk;
    parts_.unpack(packed, chunk);
    if (chunk.face_corner_counts_size() > 0 || chunk.vertex_coordinates_size() > 0 || chunk.materials_size() > 0)
      parts_.fail("has more than surroundings");
    chunk.clear_up_axis();
    chunk.clear_quantity();
    add_chunk(chunk);
  }

  void add_leaves(const v1::LeafValues& message) {
    std::vector<LeafValue> values;
    if (const auto fault = decode_leaves(message, values)) parts_.fail(fault->text());
    if (values.empty()) return;
    if (leaves_.size() + values.size() > header_.leaf_count()) parts_.fail("more leaves than the header says");
    if (!leaves_.empty() && !(leaves_.back().patch.range_max() < values.front().patch.range_min() &&
                              leaves_.back().patch.agrees_on_splits(values.front().patch)))
      parts_.fail("its leaves do not follow those before");
    leaves_.insert(leaves_.end(), values.begin(), values.end());
  }

  void add_errors(const v1::LeafErrors& message) {
    ErrorPage page;
    if (const auto fault = decode_errors(message, page)) parts_.fail(fault->text());
    const std::size_t first = errors_.size();
    if (first + page.codes.size() > leaves_.size() || leaves_[first].patch != page.first)
      parts_.fail("tells errors of leaves that are not there");
    for (const std::uint8_t code : page.codes) errors_.push_back(page.coding.unpack(code));
  }

  BaseMesh base_mesh() {
    Scene scene = scene_.take();
    objects_.swap(scene.objects);  // their faces are not those of this scene
    if (const auto fault = find_fault(scene)) throw SolutionFileError(fault->text());
    BaseMeshOptions options;
    options.faces_are_roots = true;
    BaseMesh mesh(scene, options);
    if (mesh.roots().size() != header_.root_count() || sources_.size() != fronts_)
      throw SolutionFileError("mesh: " + std::to_string(mesh.roots().size()) + " root patches, but the header says " +
                              std::to_string(header_.root_count()));
    return mesh;
  }

  /// Throws unless the leaves cover each root of the mesh once, and none or all of them have errors.
  void check_leaves(const BaseMesh& mesh) const {
    constexpr std::uint64_t whole = std::uint64_t{1} << (2 * PatchId::max_level);
    std::vector<std::uint64_t> covered(mesh.roots().size());
    for (const LeafValue& leaf : leaves_) {
      if (leaf.patch.root_face() >= covered.size())
        throw SolutionFileError("leaves: there is no root patch " + std::to_string(leaf.patch.root_face()));
      if (leaf.patch.has_slabs() && mesh.roots()[leaf.patch.root_face()].corner_count != 4)
        throw SolutionFileError("leaves: root patch " + std::to_string(leaf.patch.root_face()) + " is a triangle and has slabs");
      covered[leaf.patch.root_face()] += whole >> (2 * leaf.patch.level());
    }
    for (std::size_t root = 0; root < covered.size(); ++root)
      if (covered[root] != whole)
        throw SolutionFileError("leaves: they do not cover root patch " + std::to_string(root) + " exactly");
    if (leaves_.size() != header_.leaf_count()) throw SolutionFileError("leaves: some are missing");
    if (errors_.size() != (header_.has_errors() ? leaves_.size() : 0)) throw SolutionFileError("errors: some are missing");
  }

  PartReader parts_;
  const std::uint64_t most_leaves_;
  v1::SolutionHeader header_;
  SceneAssembler scene_;
  VertexIndex vertices_;
  std::uint64_t fronts_ = 0, backs_ = 0;
  std::vector<InputFaces> sources_;  ///< by face of the scene that is rebuilt: the faces of the scene that was solved
  std::vector<SceneObject> objects_;
  std::vector<LeafValue> leaves_;
  std::vector<float> errors_;
};

}  // namespace

DisplayMesh decode_compact(std::string_view bytes) { return Reader(bytes).read(); }

}  // namespace alvor
