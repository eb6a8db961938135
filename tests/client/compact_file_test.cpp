// Tests of compact solution files and of files for ParaView.

#include "client/export/compact_file.h"

#include "client/export/part_stream.h"
#include "client/export/solution_file.h"
#include "client/export/vtu_file.h"
#include "meshing/edit/edited_scene.h"
#include "meshing/mesh_area.h"
#include "proto/codec.h"
#include "proto/leaf_codec.h"
#include "solution/shared_exponent.h"
#include "tests/scenes.h"
#include "tests/textures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>
#include <span>

namespace alvor {
namespace {

/// Returns a scene with what meshes can have: polygons that are cut, triangles, both sides, faces back to back, textures,
/// colours, lamps and objects. Triangles are joined where `all_triangles`.
Scene varied_scene(bool all_triangles) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(3, 0.2), test::textured(test::noise(4, 3))};
  scene.materials[0].two_sided = true;
  scene.materials[1].name = "lamp";
  if (!all_triangles) {
    test::add_polygon(scene, {{0, 0, 0}, {4, 0, 0}, {4, 0, 4}, {2, 0, 2}, {0, 0, 4}});  // concave
    test::add_polygon(scene, {{0, 0, 4}, {0, 3, 4}, {0, 3, 0}, {0, 0, 0}}, 1);
    test::add_polygon(scene, {{0, 0, 0}, {0, 3, 0}, {0, 3, 4}, {0, 0, 4}}, 1);  // back to back with the last
  }
  test::add_polygon(scene, {{0, 0, 0}, {0, 3, 0}, {4, 3, 0}});
  test::add_polygon(scene, {{0, 0, 0}, {4, 3, 0}, {4, 0, 0}});
  test::add_polygon(scene, {{5, 1, 0}, {5, 1, 1}, {6, 1, 1}}, 1);
  test::complete_texture_points(scene);
  test::add_textured(scene, {{0, 3, 0}, {4, 3, 0}, {4, 3, 4}}, {{0, 0}, {2, 0}, {2, 1}}, 2);
  scene.corner_colours.assign(scene.corners.size(), {1, 0.5F, 0.25F});
  scene.corner_colours.back() = {0, 0, 1};
  Light lamp{"bulb", LightKind::point, {1, 2, 3}, {2, 2, 2}};
  scene.lights = {lamp};
  scene.objects = {{"room", std::nullopt, {}, 0, 2}, {"roof", 0, {}, 2, static_cast<std::uint32_t>(scene.faces.size()) - 2}};
  scene.up = UpAxis::z;
  scene.quantity = Quantity::photometric;
  return scene;
}

/// Returns leaves of different sizes with random light, some of them slabs unless none are wanted.
std::vector<LeafValue> random_leaves(const BaseMesh& mesh, int seed, bool has_slabs = true) {
  std::mt19937 random(static_cast<std::uint32_t>(seed));
  std::vector<LeafValue> leaves;
  const std::function<void(PatchId)> add = [&](PatchId patch) {
    if (patch.level() < 4 && random() % 3 != 0) {
      const bool may_be_slabs = has_slabs && mesh.roots()[patch.root_face()].corner_count == 4;
      Split how = may_be_slabs ? static_cast<Split>(random() % 3) : Split::quarters;
      if (!patch.may_split(how)) how = Split::quarters;
      for (int k = 0; k < 4; ++k) add(patch.child(k, how));
      return;
    }
    const auto light = [&] { return static_cast<float>(random() % 1000) / 7; };
    leaves.push_back({patch, {light(), light(), light()}});
  };
  for (std::uint32_t root = 0; root < mesh.roots().size(); ++root) add(PatchId::root(root));
  return leaves;
}

/// Returns leaves as a file holds them.
std::vector<LeafValue> rounded(std::vector<LeafValue> leaves) {
  float largest = 0;
  for (const LeafValue& leaf : leaves) largest = std::max(largest, leaf.irradiance.max());
  const SharedExponent coding = SharedExponent::for_values_up_to(largest);
  for (LeafValue& leaf : leaves) leaf.irradiance = coding.unpack(coding.pack(leaf.irradiance));
  return leaves;
}

TEST(CompactFile, HoldsWhatTheDisplayMeshHas) {
  for (const bool all_triangles : {false, true}) {
    const Scene scene = varied_scene(all_triangles);
    ASSERT_FALSE(find_fault(scene)) << find_fault(scene)->text();
    const BaseMesh mesh(scene);
    const auto leaves = random_leaves(mesh, 1);
    std::vector<float> errors;
    for (const LeafValue& leaf : leaves) errors.push_back(0.1F * leaf.irradiance.g);
    const DisplayMesh read = decode_compact(encode_compact(mesh, leaves, errors)),
                      made = build_display_mesh(mesh, rounded(leaves), errors);
    EXPECT_EQ(read.positions, made.positions);
    EXPECT_EQ(read.normals, made.normals);
    EXPECT_EQ(read.irradiance, made.irradiance);
    EXPECT_EQ(read.radiosity, made.radiosity);
    EXPECT_EQ(read.triangles, made.triangles);
    EXPECT_EQ(read.texture_points, made.texture_points);
    EXPECT_EQ(read.faces, made.faces);
    EXPECT_EQ(read.objects, made.objects);
    EXPECT_EQ(read.lights, made.lights);
    EXPECT_EQ(read.up, made.up);
    EXPECT_EQ(read.quantity, made.quantity);
    ASSERT_EQ(read.materials.size(), made.materials.size());
    EXPECT_EQ(read.materials[1].name, "lamp");
    EXPECT_EQ(read.materials[2].texture->image->texels, made.materials[2].texture->image->texels);
    ASSERT_EQ(read.errors.size(), made.errors.size());
    for (std::size_t v = 0; v < read.errors.size(); ++v) EXPECT_NEAR(read.errors[v], made.errors[v], 0.05 * made.errors[v]);
  }
}

/// Returns the sum over all triangles of the green light that arrives there, times the place of their middle, W m.
Vec3 moment_on(const DisplayMesh& mesh) {
  Vec3 moment;
  for (std::uint32_t n = 0; n < mesh.triangles.size(); ++n) {
    const auto& [a, b, c] = mesh.triangles[n];
    const double light = double(mesh.irradiance[a].g) + mesh.irradiance[b].g + mesh.irradiance[c].g;
    const Vec3 middle = (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) / 3;
    moment = moment + length(double_area_of(mesh, n)) / 6 * light * middle;
  }
  return moment;
}

/// Expects that a file holds what is shown of an edited scene, in whatever order and triangles.
void expect_same_light(const Scene& scene, const std::vector<SceneEdit>& edits) {
  ASSERT_FALSE(fault_in(edits, scene)) << fault_in(edits, scene)->reason;
  const Scene edited = edited_scene(scene, edits);
  const BaseMesh mesh = BaseMesh(scene).edited_as(edited);
  const auto leaves = random_leaves(mesh, 1);
  std::vector<float> errors;
  for (const LeafValue& leaf : leaves) errors.push_back(0.1F * leaf.irradiance.g);
  const DisplayMesh read = decode_compact(encode_compact(mesh, leaves, errors)), made = build_display_mesh(mesh, leaves, errors);
  EXPECT_EQ(read.objects, made.objects);
  const Vec3 moment = moment_on(made);
  EXPECT_LT(length(moment_on(read) - moment), 0.003 * length(moment));
}

TEST(CompactFile, HoldsWhatIsThereOfAnEditedScene) {
  Scene scene = varied_scene(false);
  for (Material& material : scene.materials) material.two_sided = true;
  const std::string room = scene.objects[0].name;
  expect_same_light(scene, {ObjectCopy{.name = "twin", .of = room}, ObjectEdit{.name = room, .hidden = true},
                            ObjectEdit{.name = "twin", .move = Vec3{0.1, 0, 0}}});
}

TEST(CompactFile, HoldsAFaceThatWasMovedAgainstTheBackOfAnother) {
  Scene scene;
  scene.materials = {test::grey(1, 0.5)};
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, 2}, {0, 2, 2}, {0, 2, 0}});
  test::add_polygon(scene, {{1, 2, 0}, {1, 2, 2}, {1, 0, 2}, {1, 0, 0}});
  scene.objects = {{.name = "a", .first_face = 0, .face_count = 1}, {.name = "b", .first_face = 1, .face_count = 1}};
  expect_same_light(scene, {ObjectEdit{.name = "b", .move = Vec3{-1, 0, 0}}});
}

TEST(CompactFile, HoldsTexturesAndColoursOfTheFirstFaceThatIsThere) {
  Scene scene;
  scene.materials = {test::grey(1, 0.5), test::textured(test::noise(4, 3))};
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, 2}, {0, 2, 2}, {0, 2, 0}});
  test::complete_texture_points(scene);
  test::add_textured(scene, {{0, 3, 0}, {4, 3, 0}, {4, 3, 4}}, {{0, 0}, {2, 0}, {2, 1}}, 1);
  scene.corner_colours.assign(scene.corners.size(), {1, 0.5F, 0.25F});
  scene.objects = {{.name = "a", .first_face = 0, .face_count = 1}, {.name = "b", .first_face = 1, .face_count = 1}};
  const Scene edited = edited_scene(scene, std::vector<SceneEdit>{ObjectEdit{.name = "a", .hidden = true}});
  const BaseMesh mesh = BaseMesh(scene).edited_as(edited);
  const auto leaves = random_leaves(mesh, 1);
  const DisplayMesh read = decode_compact(encode_compact(mesh, leaves)), made = build_display_mesh(mesh, rounded(leaves));
  EXPECT_EQ(read.texture_points, made.texture_points);
  EXPECT_EQ(read.positions, made.positions);
  EXPECT_EQ(read.radiosity, made.radiosity);
  EXPECT_EQ(read.faces, made.faces);
}

TEST(CompactFile, OfASceneOfWhichNothingIsThereIsNotWritten) {
  Scene scene;
  scene.materials = {test::grey(1, 0.5)};
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, 2}, {0, 2, 2}, {0, 2, 0}});
  scene.objects = {{.name = "a", .first_face = 0, .face_count = 1}};
  const Scene edited = edited_scene(scene, std::vector<SceneEdit>{ObjectEdit{.name = "a", .hidden = true}});
  const BaseMesh mesh = BaseMesh(scene).edited_as(edited);
  EXPECT_THROW((void)encode_compact(mesh, random_leaves(mesh, 1)), SolutionFileError);
}

TEST(CompactFile, TakesTenBytesALeafAtMost) {
  Scene scene;
  scene.materials = {test::grey(1, 0.5)};
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, true);
  const BaseMesh mesh(scene);
  std::vector<LeafValue> leaves;
  std::vector<float> errors;
  std::mt19937 random(1);
  const std::function<void(PatchId)> add = [&](PatchId patch) {  // noise is the worst case
    if (patch.level() < 6) {
      for (int k = 0; k < 4; ++k) add(patch.child(k));
      return;
    }
    const auto light = [&] { return static_cast<float>(random() % 10000); };
    leaves.push_back({patch, {light(), light(), light()}});
    errors.push_back(light());
  };
  for (std::uint32_t root = 0; root < 6; ++root) add(PatchId::root(root));
  EXPECT_LT(encode_compact(mesh, leaves, errors).size(), 10 * leaves.size());
}

TEST(CompactFile, WithoutErrorsTellsNone) {
  const BaseMesh mesh(varied_scene(false));
  EXPECT_TRUE(decode_compact(encode_compact(mesh, random_leaves(mesh, 2))).errors.empty());
}

TEST(CompactFile, IsOfVersionOneUnlessItHasSlabs) {
  const BaseMesh mesh(varied_scene(false));
  for (const bool has_slabs : {false, true}) {
    const std::string bytes = encode_compact(mesh, random_leaves(mesh, 1, has_slabs));
    PartReader reader(bytes);
    EXPECT_EQ(reader.next()->header().version(), has_slabs ? 2u : 1u);
  }
}

class HostileCompactFile : public testing::Test {
 protected:
  HostileCompactFile() : mesh_(varied_scene(false)), leaves_(random_leaves(mesh_, 3)) {
    bytes_ = encode_compact(mesh_, leaves_, std::vector<float>(leaves_.size(), 1.0F));
    PartReader reader(bytes_);
    while (auto part = reader.next()) parts_.push_back(*std::move(part));
  }
  std::string written() const {
    std::string bytes(compact_magic);
    for (const v1::SolutionPart& part : parts_) append_part(bytes, part);
    return bytes;
  }
  void expect_refused(const std::string& reason) const {
    try {
      (void)decode_solution(written(), ".alvor", "room.alvor");
      ADD_FAILURE() << "was read, though: " << reason;
    } catch (const SolutionFileError& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
      EXPECT_TRUE(std::string(error.what()).starts_with("room.alvor: "));
    }
  }
  v1::SolutionPart& part_with(v1::SolutionPart::PartCase kind) {
    for (v1::SolutionPart& part : parts_)
      if (part.part_case() == kind) return part;
    throw std::logic_error("there is no such part");
  }
  const BaseMesh mesh_;
  const std::vector<LeafValue> leaves_;
  std::string bytes_;
  std::vector<v1::SolutionPart> parts_;
};

TEST_F(HostileCompactFile, OfAllLengthsIsRefused) {
  for (std::size_t length = 0; length < bytes_.size(); ++length)
    EXPECT_THROW((void)decode_solution(bytes_.substr(0, length), ".alvor", "room.alvor"), SolutionFileError) << length;
}

TEST_F(HostileCompactFile, OfAnotherVersionIsRefused) {
  parts_[0].mutable_header()->set_version(3);
  expect_refused("version 3 is not known");
}

TEST_F(HostileCompactFile, WithCountsThatAreWrongIsRefused) {
  parts_[0].mutable_header()->set_root_count(3);
  expect_refused("but the header says 3");
  parts_[0].mutable_header()->set_root_count(PatchId::most_roots + 1);
  expect_refused("more root patches than there can be");
  parts_[0].mutable_header()->set_root_count(mesh_.roots().size());
  parts_[0].mutable_header()->set_leaf_count(leaves_.size() + 1);
  expect_refused("leaves: some are missing");
  parts_[0].mutable_header()->set_leaf_count(leaves_.size() - 1);
  expect_refused("more leaves than the header says");
  parts_[0].mutable_header()->set_leaf_count(std::uint64_t{1} << 60);
  expect_refused("more leaves than a file of this size can hold");
}

TEST_F(HostileCompactFile, ThatWouldUnpackToMuchIsRefused) {
  part_with(v1::SolutionPart::kMesh).mutable_mesh()->set_raw_size(1U << 31);
  expect_refused("would take too much memory");
}

TEST_F(HostileCompactFile, WithLeavesThatDoNotCoverTheMeshIsRefused) {
  const v1::SolutionPart leaves = part_with(v1::SolutionPart::kLeaves);
  parts_.insert(parts_.end() - 1, leaves);  // twice
  parts_[0].mutable_header()->set_leaf_count(2 * leaves_.size());
  expect_refused("do not follow those before");
}

TEST_F(HostileCompactFile, WithLeavesThatContradictEachOtherIsRefused) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5)};
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  const BaseMesh quad(scene);
  const auto with = [&](Split of_first, Split of_last) {
    const PatchId root = PatchId::root(0);
    std::vector<LeafValue> leaves;
    for (int k = 0; k < 4; ++k) leaves.push_back({root.child(k, k < 2 ? of_first : of_last), {1, 1, 1}});
    parts_.clear();
    const std::string bytes = encode_compact(quad, leaves);
    PartReader reader(bytes);
    while (auto part = reader.next()) {
      if (part->part_case() != v1::SolutionPart::kLeaves) {
        parts_.push_back(*std::move(part));
        continue;
      }
      for (const auto half : {std::span(leaves).first(2), std::span(leaves).last(2)})
        *parts_.emplace_back().mutable_leaves() = encode_leaves(half, Detail::exact, SharedExponent(0));
    }
  };
  with(Split::slabs_along_u, Split::slabs_along_u);
  EXPECT_NO_THROW((void)decode_solution(written(), ".alvor", "room.alvor"));
  with(Split::slabs_along_u, Split::slabs_along_v);
  expect_refused("do not follow those before");
}

TEST_F(HostileCompactFile, WithSlabsOfATriangleIsRefused) {
  std::vector<LeafValue> leaves = leaves_;
  const auto triangle = std::ranges::find_if(leaves, [&](const LeafValue& leaf) {
    return mesh_.roots()[leaf.patch.root_face()].corner_count == 3 && leaf.patch.level() > 0;
  });
  ASSERT_NE(triangle, leaves.end());
  const std::uint32_t root = triangle->patch.root_face();
  const int along_u_at_level_0 = 1;
  for (LeafValue& leaf : leaves)
    if (leaf.patch.root_face() == root) leaf.patch = leaf.patch.with_slab_code(along_u_at_level_0);
  std::erase_if(parts_, [](const v1::SolutionPart& part) { return part.part_case() == v1::SolutionPart::kErrors; });
  parts_[0].mutable_header()->set_has_errors(false);
  *part_with(v1::SolutionPart::kLeaves).mutable_leaves() = encode_leaves(leaves, Detail::exact, SharedExponent(0));
  expect_refused("is a triangle and has slabs");
}

TEST_F(HostileCompactFile, WithoutAPartIsRefused) {
  for (const auto kind :
       {v1::SolutionPart::kMesh, v1::SolutionPart::kLeaves, v1::SolutionPart::kHeader, v1::SolutionPart::kImages}) {
    auto all = parts_;
    std::erase_if(parts_, [&](const v1::SolutionPart& part) { return part.part_case() == kind; });
    EXPECT_THROW((void)decode_solution(written(), ".alvor", "room.alvor"), SolutionFileError) << kind;
    parts_ = std::move(all);
  }
}

TEST_F(HostileCompactFile, WithFlippedBitsIsReadOrRefused) {
  std::mt19937 random(5);
  for (int n = 0; n < 3000; ++n) {
    std::string bytes = bytes_;
    for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] ^= static_cast<char>(1U << random() % 8);
    try {
      (void)decode_solution(bytes, ".alvor", "room.alvor");
    } catch (const SolutionFileError&) {}
  }
}

TEST(VtuFile, SaysWhereItsArraysAreAndHowLong) {
  const BaseMesh mesh(varied_scene(false));
  const auto leaves = random_leaves(mesh, 4);
  const DisplayMesh shown = build_display_mesh(mesh, leaves, std::vector<float>(leaves.size(), 0.5F));
  const std::string file = encode_vtu(shown);
  const std::size_t data = file.find("\n_") + 2;
  const auto array_of = [&](const std::string& name, std::size_t after = 0) {
    const std::size_t tag = file.find("Name=\"" + name + "\"", after), offset = file.find("offset=\"", tag) + 8;
    return data + std::stoull(file.substr(offset, 20));
  };
  const auto length_at = [&](std::size_t place) {
    std::uint64_t length = 0;
    std::memcpy(&length, file.data() + place, sizeof length);
    return length;
  };
  EXPECT_EQ(length_at(array_of("irradiance")), 12 * shown.positions.size());
  EXPECT_EQ(length_at(array_of("points")), 24 * shown.positions.size());
  EXPECT_EQ(length_at(array_of("connectivity")), 24 * shown.triangles.size());
  EXPECT_EQ(length_at(array_of("types")), shown.triangles.size());
  EXPECT_EQ(length_at(array_of("material")), 4 * shown.triangles.size());
  EXPECT_EQ(length_at(array_of("error", file.find("<CellData"))), 4 * shown.triangles.size());
  double x = 0;
  std::memcpy(&x, file.data() + array_of("points") + 8, sizeof x);
  EXPECT_EQ(x, shown.positions[0].x);
  EXPECT_THROW((void)decode_solution(file, ".vtu", "room.vtu"), SolutionFileError);
}

}  // namespace
}  // namespace alvor
