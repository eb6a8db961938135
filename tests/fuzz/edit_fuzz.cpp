// Fuzzes the steps of edits that EditSolve is sent. Aborts if a step that is taken breaks a promise.

#include "proto/edit_codec.h"
#include "server/base/status_error.h"
#include "server/solves/edited_content.h"
#include "tests/fuzz/input.h"
#include "tests/scenes.h"

#include <cmath>
#include <cstdlib>

namespace alvor {
namespace {

void expect(bool holds) {
  if (!holds) std::abort();
}

/// Returns a room with named objects, one of which hangs from another, and lights.
std::shared_ptr<const SceneContent> room() {
  Scene scene = test::room_of_objects();
  scene.objects[2].parent = 0;
  scene.lights = {Light{"bulb", LightKind::point, {9, 8, 7}, {3, 2, 4}}, Light{"sun", LightKind::directional, {60, 60, 50}}};
  scene.lights[1].direction = {0, -1, 0};
  BaseMesh mesh(scene);
  return std::make_shared<const SceneContent>(SceneContent{std::move(scene), std::move(mesh)});
}

/// Returns scenes that can be added: both of the other up axis, one with a lamp that is no face.
AddedContents others() {
  AddedContents others;
  for (const bool has_lamp : {false, true}) {
    Scene scene;
    scene.materials = {test::grey(1, 0.5)};
    scene.materials[0].two_sided = true;
    test::add_box(scene, {1, 1, 1}, {2, 2, 2}, false);
    scene.up = UpAxis::z;
    if (has_lamp) scene.lights = {Light{"bulb", LightKind::point, {1, 1, 1}, {3, 2, 4}}};
    BaseMesh mesh(scene);
    others[has_lamp ? "scenes/lamp" : "scenes/box"] =
        std::make_shared<const SceneContent>(SceneContent{std::move(scene), std::move(mesh)});
  }
  return others;
}

/// The mesh has the submitted roots, somewhere, then those of added objects, and its links lead both ways.
void check(const BaseMesh& submitted, const BaseMesh& mesh) {
  const auto roots = mesh.roots();
  expect(roots.size() >= submitted.roots().size() && std::isfinite(mesh.extent()) && mesh.extent() > 0);
  for (std::uint32_t r = 0; r < roots.size(); ++r) {
    expect(roots[r].material < mesh.materials().size());
    if (r < submitted.roots().size()) expect(roots[r].corner_count == submitted.roots()[r].corner_count);
    expect(std::abs(length(roots[r].normal) - 1) < 1e-9);
    if (roots[r].twin != RootPatch::no_twin) expect(roots[roots[r].twin].twin == r);
    if (roots[r].is_hidden) expect(roots[r].is_behind && mesh.material_of(r).emission.is_zero());
    for (int e = 0; e < roots[r].corner_count; ++e) {
      expect(std::isfinite(length(roots[r].corners[static_cast<std::size_t>(e)])));
      if (const auto other = mesh.across(r, e)) expect(mesh.across(other->root, other->edge)->root == r);
    }
  }
}

void run(fuzz::Input input) {
  static const auto submitted = room();
  static const auto added = others();
  std::vector<KeptEdit> edits;
  for (int n = 0; n < 50 && !input.empty(); ++n) {
    v1::EditStep message;
    EditRequest request{.continues = input.byte() % 2 == 1};
    const std::string_view text = input.text();
    if (!message.ParseFromArray(text.data(), static_cast<int>(text.size()))) continue;
    const auto step = decode(message);
    if (!step) continue;
    request.step = *step;
    request.author = message.author();
    try {
      EditedContent edited = with_step(edits, request, submitted, added);
      edits = std::move(edited.edits);
      expect(!find_fault(edited.content->scene));
      check(submitted->mesh, edited.content->mesh);
      for (const Light& light : edited.content->scene.lights) expect(!light.is_hidden || light.intensity.is_zero());
      const auto replayed = edited_content(submitted, edits, added);
      for (std::uint32_t r = 0; r < replayed->mesh.roots().size(); ++r)
        expect(replayed->mesh.roots()[r].corners == edited.content->mesh.roots()[r].corners);
    } catch (const StatusError&) {}
  }
}

}  // namespace
}  // namespace alvor

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  alvor::run({data, size});
  return 0;
}
