#include "server/scene_store.h"

#include "server/random_id.h"
#include "server/status_error.h"

#include <google/protobuf/util/time_util.h>

#include <algorithm>

namespace alvor {

namespace {

constexpr std::size_t longest_display_name = 256;

bool emits(const BaseMesh& mesh) {
  return std::ranges::any_of(mesh.roots(),
                             [&](const RootPatch& root) { return !mesh.materials()[root.material].emission.is_zero(); });
}

void describe_mesh(const BaseMesh& mesh, v1::Scene& facts) {
  const WeldReport& report = mesh.weld_report();
  const auto warn = [&](std::size_t count, const char* sentence) {
    if (count > 0) facts.add_warnings(std::to_string(count) + sentence);
  };
  warn(report.degenerate_faces, " degenerate faces (no area) were left out.");
  warn(report.split_faces, " polygons were cut up: they have more than four corners, are concave or not planar.");
  warn(report.non_manifold_faces, " faces share an edge with more than one other: light does not blend across it.");
  if (!emits(mesh)) facts.add_warnings("No face emits light: the solution will be dark.");
}

v1::Scene facts_of(const Scene& scene, const BaseMesh& mesh, const std::string& display_name) {
  v1::Scene facts;
  facts.set_name("scenes/" + random_id('s'));
  facts.set_display_name(display_name);
  *facts.mutable_create_time() = google::protobuf::util::TimeUtil::GetCurrentTime();
  facts.set_vertex_count(scene.vertices.size());
  facts.set_face_count(scene.faces.size());
  facts.set_material_count(scene.materials.size());
  describe_mesh(mesh, facts);
  return facts;
}

}  // namespace

std::shared_ptr<const StoredScene> SceneStore::add(Scene scene, const std::string& display_name) {
  if (display_name.size() > longest_display_name)
    throw invalid_argument("scene.display_name: " + std::to_string(display_name.size()) + " bytes, at most 256 are allowed");
  if (const auto fault = find_fault(scene)) throw invalid_argument(fault->text());
  BaseMesh mesh(scene);
  if (mesh.roots().empty()) throw invalid_argument("scene: all of its faces are degenerate (no area)");
  v1::Scene facts = facts_of(scene, mesh, display_name);

  std::scoped_lock hold(lock_);
  auto stored =
      std::make_shared<const StoredScene>(StoredScene{next_number_++, std::move(facts), std::move(scene), std::move(mesh)});
  scenes_[stored->facts.name()] = {stored, std::make_shared<const int>(0)};
  return stored;
}

const SceneUse& SceneStore::entry(const std::string& name) const {
  const auto found = scenes_.find(name);
  if (found == scenes_.end()) throw not_found(name);
  return found->second;
}

std::shared_ptr<const StoredScene> SceneStore::find(const std::string& name) const {
  std::scoped_lock hold(lock_);
  return entry(name).scene;
}

SceneUse SceneStore::use(const std::string& name) const {
  std::scoped_lock hold(lock_);
  return entry(name);
}

Page<const StoredScene> SceneStore::list(const PageRequest& request) const {
  std::vector<std::shared_ptr<const StoredScene>> all;
  {
    std::scoped_lock hold(lock_);
    for (const auto& [name, use] : scenes_) all.push_back(use.scene);
  }
  return cut_page(std::move(all), request);
}

void SceneStore::remove(const std::string& name) {
  SceneUse removed;  // freed after the lock is
  std::scoped_lock hold(lock_);
  // First uses are only handed out under this lock, so a count of one cannot grow meanwhile.
  if (entry(name).token.use_count() > 1) throw StatusError(grpc::FAILED_PRECONDITION, name + " has solves: delete them first");
  removed = std::move(scenes_.extract(name).mapped());
}

}  // namespace alvor
