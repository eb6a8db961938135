// make_vectors DIRECTORY: writes the test vectors; to be run when the format of frames has changed. Each run writes the same.

#include "meshing/edit/edited_scene.h"
#include "proto/codec.h"
#include "proto/mesh_codec.h"
#include "server/solves/edited_look.h"
#include "solution/solution_log.h"
#include "solution/solution_mirror.h"
#include "tests/scenes.h"
#include "tests/server/growing_leaves.h"
#include "tests/vectors/vectors.h"

#include <cmath>
#include <iostream>
#include <span>

namespace alvor {
namespace {

struct Case {
  const char* name;
  Detail detail;
  std::uint32_t roots;
  std::size_t leaves_per_frame;
  int revisions;
  bool is_uneven = false;  ///< some bands are zero, and neighbours differ a billionfold
  bool has_errors = false;
  bool merges = false;
  bool slabs = false;
};

void make_uneven(std::vector<LeafValue>& leaves) {
  for (std::size_t n = 0; n < leaves.size(); ++n) {
    RgbF& value = leaves[n].irradiance;
    value = value * std::ldexp(1.0f, -static_cast<int>(7 * n % 31));
    (n % 4 == 0 ? value.r : n % 4 == 1 ? value.g : value.b) = 0;
  }
}

/// Returns errors of many sizes, some of them 0.
std::vector<float> errors_of(std::span<const LeafValue> leaves) {
  std::vector<float> errors;
  for (std::size_t n = 0; n < leaves.size(); ++n) errors.push_back(n % 11 == 0 ? 0 : std::ldexp(0.7f, -static_cast<int>(n % 29)));
  return errors;
}

/// Writes one watch: frames of a few leaves, with new revisions between them.
void write(const Case& how, const std::filesystem::path& directory) {
  SolutionLog log;
  SolutionMirror mirror;
  GrowingLeaves leaves(how.roots, 7, how.merges, how.slabs);
  std::vector<v1::WatchSolveResponse> frames;
  Cursor cursor{.errors = {.are_wanted = how.has_errors}};
  for (int left = how.revisions;;) {
    if (left > 0 && frames.size() % 3 == 0) {
      Step step;
      step.displayed_error = 0.01;
      std::vector<LeafValue> changed = leaves.next();
      if (how.is_uneven) make_uneven(changed);
      log.publish(changed, step, how.has_errors ? errors_of(changed) : std::vector<float>());
      --left;
    }
    const Delta delta = log.since(cursor, how.detail, how.leaves_per_frame);
    cursor = delta.next;
    encode(delta, frames.emplace_back());
    if (const auto fault = mirror.apply(delta)) throw std::runtime_error(*fault);
    if (left == 0 && delta.whole() && !delta.has_more_errors) break;
  }
  const auto path = directory / how.name;
  std::ofstream(path.string() + ".frames", std::ios::binary) << vectors::bytes_of(frames);
  std::ofstream(path.string() + ".leaves", std::ios::binary) << vectors::bytes_of(mirror.leaves());
  if (how.has_errors) std::ofstream(path.string() + ".errors", std::ios::binary) << vectors::bytes_of(mirror.errors());
}

std::vector<v1::ReadMeshResponse> mesh_messages(const BaseMesh& mesh) {
  std::vector<v1::ReadMeshResponse> messages;
  MeshSlicer slicer(mesh, 50, MeshParts::all);
  for (v1::ReadMeshResponse message; slicer.next(message);) messages.push_back(message);
  return messages;
}

/// Returns steps that move, turn, recolour, dim, copy, hide and take back.
std::vector<EditStep> steps_of_edits() {
  using Kind = EditStep::Kind;
  const auto move = [](const char* name, Vec3 by) { return ObjectEdit{.name = name, .move = by}; };
  MaterialEdit recolour;
  recolour.name = "m0";
  recolour.reflectance = Rgb{0.3, 0.2, 0.1};
  ObjectEdit turned = move("box", {0.5, 0, 0.3});
  turned.turn = 30;
  return {{Kind::edit, {turned, recolour}},
          {Kind::edit, {ObjectCopy{.name = "box.1", .of = "box"}, move("box.1", {-0.7, 0.1, 0.9})}},
          {Kind::edit, {ObjectEdit{.name = "lamp", .dim = 0.5}, ObjectEdit{.name = "block", .hidden = true}}},
          {Kind::undo, {}},
          {Kind::redo, {}},
          {Kind::edit, {ObjectCopy{.name = "box.2", .of = "box.1"}, ObjectEdit{.name = "box", .hidden = true}}},
          {Kind::edit, {ObjectCopy{.name = "lamp.1", .of = "lamp"}}},
          {Kind::undo, {}}};
}

/// Writes a watch of a scene that is edited: after each step all root patches have leaves of new values, the first of them four.
void write_edits(const std::filesystem::path& directory) {
  const Scene scene = test::room_of_objects();
  const auto submitted = std::make_shared<const SceneContent>(SceneContent{scene, BaseMesh(scene)});
  SolutionLog log;
  SolutionMirror mirror;
  std::vector<v1::WatchSolveResponse> frames;
  EditedContent now{{}, submitted};
  Cursor cursor;
  const auto watch = [&] {
    Step step;
    step.edits = newest_revision(now.edits);
    std::vector<LeafValue> values;
    for (std::uint32_t root = 0; root < now.content->mesh.roots().size(); ++root) {
      const auto light = static_cast<float>(1 + root + 100 * step.edits);
      if (root > 0) values.push_back({PatchId::root(root), {light, 2 * light, 3 * light}});
      for (int k = 0; root == 0 && k < 4; ++k) values.push_back({PatchId::root(root).child(k), {light, light, light}});
    }
    log.publish(values, step);
    const Delta delta = log.since(cursor, Detail::exact, 1000);
    cursor = delta.next;
    encode(delta, frames.emplace_back());
    if (step.edits > 0) *frames.back().mutable_look() = look_of(*now.content, now.edits);
    if (const auto fault = mirror.apply(delta)) throw std::runtime_error(*fault);
  };
  watch();
  for (const EditStep& step : steps_of_edits()) {
    now = with_step(now.edits, {.step = step}, submitted);
    watch();
  }
  const auto write_file = [&](const char* ending, const std::string& bytes) {
    std::ofstream((directory / "edits").string() + ending, std::ios::binary) << bytes;
  };
  write_file(".frames", vectors::bytes_of(frames));
  write_file(".leaves", vectors::bytes_of(mirror.leaves()));
  write_file(".submitted", vectors::bytes_of(mesh_messages(submitted->mesh)));
  write_file(".edited", vectors::bytes_of(mesh_messages(now.content->mesh)));
}

}  // namespace
}  // namespace alvor

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: make_vectors DIRECTORY\n";
    return 2;
  }
  using alvor::Detail;
  for (const alvor::Case& how :
       {alvor::Case{"display", Detail::display, 30, 50, 20}, alvor::Case{"exact", Detail::exact, 30, 50, 20},
        alvor::Case{"deep", Detail::display, 1, 1000, 60}, alvor::Case{"one_page", Detail::exact, 2000, 5000, 2},
        alvor::Case{"uneven", Detail::display, 200, 300, 6, true}, alvor::Case{"errors", Detail::display, 30, 8, 10, false, true},
        alvor::Case{"merges", Detail::display, 6, 40, 40, false, false, true},
        alvor::Case{"slabs", Detail::display, 100, 60, 40, false, false, true, true}})
    alvor::write(how, argv[1]);
  alvor::write_edits(argv[1]);
}
