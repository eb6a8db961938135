#include "server/scenes/scene_store.h"

#include "server/archive/content.h"
#include "server/base/random_id.h"
#include "server/base/status_error.h"

#include <algorithm>

namespace alvor {

namespace {

constexpr std::size_t longest_display_name = 256;
// Memory for a scene with its mesh while the mesh is built.
constexpr std::uint64_t bytes_a_corner = 250, bytes_an_object = 500;

bool emits(const BaseMesh& mesh) {
  return !mesh.lights().empty() || std::ranges::any_of(mesh.roots(), [&](const RootPatch& root) {
    return !mesh.materials()[root.material].emission.is_zero();
  });
}

std::vector<std::string> warnings_about(const BaseMesh& mesh) {
  std::vector<std::string> warnings = warnings_of(mesh.weld_report());
  if (!emits(mesh)) warnings.emplace_back("No face emits light, and there are no lamps: the solution will be dark.");
  return warnings;
}

/// Forgets the motions of objects, and of which they are copies, as a scene has that was read from an edited solve: it counts as
/// submitted as it is now. Throws StatusError where an object or a light is hidden.
void forget_edits(Scene& scene) {
  for (const Light& light : scene.lights)
    if (light.is_hidden) throw invalid_argument("light '" + light.name + "': is hidden; leave it out instead");
  for (SceneObject& object : scene.objects) {
    if (object.is_hidden) throw invalid_argument("object '" + object.name + "': is hidden; leave its faces out instead");
    object.motion = {};
    object.copy_of.reset();
    object.from_scene.clear();
    object.first_added_light = object.added_lights = 0;
  }
}

/// Replaces each reflectance of exactly 1 by clamped_reflectance. Returns a sentence about it, or "" if there was none.
std::string clamp_reflectance_of_one(Scene& scene) {
  std::size_t count = 0;
  std::string first;
  for (Material& material : scene.materials) {
    Rgb& rho = material.reflectance;
    if (rho.r != 1 && rho.g != 1 && rho.b != 1) continue;
    for (double* band : {&rho.r, &rho.g, &rho.b})
      if (*band == 1) *band = clamped_reflectance;
    if (count++ == 0) first = material.name;
  }
  if (count == 0) return {};
  return std::to_string(count) + " materials have a reflectance of 1, which is taken for 0.95: the first is '" + first + "'.";
}

SceneRecord describe(const Scene& scene, const BaseMesh& mesh, const std::string& display_name) {
  const SceneBytes content = measure(scene);
  return {.name = "scenes/" + random_id('s'),
          .display_name = display_name,
          .create_time = std::chrono::system_clock::now(),
          .vertex_count = scene.vertices.size(),
          .face_count = scene.faces.size(),
          .material_count = scene.materials.size(),
          .object_count = scene.objects.size(),
          .light_count = scene.lights.size(),
          .quantity = scene.quantity,
          .up = scene.up,
          .north_degrees = scene.north_degrees,
          .warnings = warnings_about(mesh),
          .content_sha256 = content.sha256,
          .content_bytes = content.bytes};
}

/// Keeps the first warnings and counts the others: a page of a list of scenes must fit into a message.
void keep_first(std::vector<std::string>& warnings) {
  constexpr std::size_t most = 50;
  if (warnings.size() <= most) return;
  const std::size_t others = warnings.size() - most;
  warnings.resize(most);
  warnings.push_back("and " + std::to_string(others) + " further warnings");
}

/// Builds the mesh. Throws StatusError if `stop` ended it, or if patch ids cannot number its roots.
BaseMesh build(const Scene& scene, const CallStop& stop) {
  try {
    return BaseMesh(scene, {.stop = stop.token()});
  } catch (const TooManyRoots& fault) {
    throw invalid_argument(fault.what());
  } catch (const BuildStopped&) {
    stop.refuse_stopped();
    throw;
  }
}

}  // namespace

std::shared_ptr<const SceneContent> SceneContents::add(const std::string& sha256, Scene scene, BaseMesh mesh) {
  Lock hold(lock_);
  std::weak_ptr<const SceneContent>& known = known_[sha256];
  auto content = known.lock();
  if (!content) known = content = std::make_shared<const SceneContent>(SceneContent{std::move(scene), std::move(mesh)});
  return content;
}

std::shared_ptr<const SceneContent> SceneContents::known(const std::string& sha256) {
  Lock hold(lock_);
  std::erase_if(known_, [](const auto& entry) { return entry.second.expired(); });
  const auto found = known_.find(sha256);
  return found == known_.end() ? nullptr : found->second.lock();
}

std::shared_ptr<Mutex> SceneContents::loading(const std::string& sha256) {
  Lock hold(lock_);
  std::erase_if(loading_, [](const auto& entry) { return entry.second.expired(); });
  std::weak_ptr<Mutex>& entry = loading_[sha256];
  auto turn = entry.lock();
  if (!turn) entry = turn = std::make_shared<Mutex>();
  return turn;
}

std::shared_ptr<const SceneContent> SceneContents::find(const std::string& sha256, const CallStop& stop) {
  if (auto content = known(sha256)) return content;
  const auto turn = loading(sha256);
  Lock alone(*turn);
  if (auto content = known(sha256)) return content;
  stop.refuse_stopped();
  Scene scene = archive_->content(sha256);
  BaseMesh mesh = build(scene, stop);
  return add(sha256, std::move(scene), std::move(mesh));
}

SceneStore::SceneStore(Archive* archive, const Quota& quota, MemoryGuard memory)
    : archive_(archive), quota_(quota), memory_(memory), contents_(archive) {
  if (!archive) return;
  for (const Archive::SceneRow& row : archive->scenes())
    insert(std::make_shared<StoredScene>(row.number, Caller{row.tenant, row.request_id}, row.facts, contents_, nullptr));
  next_number_ = archive->last_scene() + 1;
}

std::shared_ptr<const StoredScene> SceneStore::add(Scene scene, const std::string& display_name, const Caller& caller,
                                                   const CallStop& stop, std::vector<std::string> warnings) {
  if (display_name.size() > longest_display_name)
    throw invalid_argument("scene.display_name: " + std::to_string(display_name.size()) + " bytes, at most 256 are allowed");
  const std::string clamped = clamp_reflectance_of_one(scene);
  forget_edits(scene);
  if (const auto fault = find_fault(scene)) throw invalid_argument(fault->text());
  memory_.admit("scene", bytes_a_corner * scene.corners.size() + bytes_an_object * scene.objects.size());
  stop.refuse_stopped();
  BaseMesh mesh = build(scene, stop);
  if (mesh.roots().empty()) throw invalid_argument("scene: all of its faces are degenerate (no area)");
  SceneRecord facts = describe(scene, mesh, display_name);
  if (!clamped.empty()) facts.warnings.push_back(clamped);
  keep_first(warnings);
  facts.warnings.insert(facts.warnings.begin(), warnings.begin(), warnings.end());

  Lock one(adding_);
  if (auto known = repeated(caller, facts)) return known;
  check_quota(caller.tenant, facts.content_bytes);
  if (archive_) archive_->add({next_number_, caller.tenant, caller.request_id, facts}, scene);
  auto content = contents_.add(facts.content_sha256, std::move(scene), std::move(mesh));
  auto stored = std::make_shared<const StoredScene>(next_number_++, caller, std::move(facts), contents_,
                                                    archive_ ? nullptr : std::move(content));
  insert(stored);
  return stored;
}

std::shared_ptr<const StoredScene> SceneStore::repeated(const Caller& caller, const SceneRecord& facts) const {
  Lock hold(lock_);
  const std::string name = requests_.find(caller);
  if (name.empty()) return nullptr;
  auto known = entry(name, caller.tenant).scene;
  if (known->facts.content_sha256 != facts.content_sha256 || known->facts.display_name != facts.display_name)
    throw other_request(caller.request_id);
  return known;
}

void SceneStore::check_quota(const std::string& tenant, std::uint64_t bytes) const {
  Lock hold(lock_);
  std::uint64_t count = 1;
  for (const auto& [name, use] : scenes_) {
    if (use.scene->creator.tenant != tenant) continue;
    ++count;
    bytes += use.scene->facts.content_bytes;
  }
  if (count > quota_.scenes)
    throw StatusError(grpc::RESOURCE_EXHAUSTED, "scenes: " + std::to_string(quota_.scenes) + " exist, as many as are allowed");
  if (bytes > quota_.scene_bytes)
    throw StatusError(grpc::RESOURCE_EXHAUSTED, "scenes: would take " + std::to_string(bytes) + " bytes, " +
                                                    std::to_string(quota_.scene_bytes) + " are allowed");
}

void SceneStore::insert(std::shared_ptr<const StoredScene> scene) {
  Lock hold(lock_);
  requests_.add(scene->creator, scene->facts.name);
  const std::string name = scene->facts.name;
  scenes_[name] = {std::move(scene), std::make_shared<const int>(0)};
}

/// Returns null where there is none.
const SceneUse* SceneStore::known(const std::string& name, const std::string& tenant) const {
  const auto found = scenes_.find(name);
  return found == scenes_.end() || found->second.scene->creator.tenant != tenant ? nullptr : &found->second;
}

const SceneUse& SceneStore::entry(const std::string& name, const std::string& tenant) const {
  if (const SceneUse* use = known(name, tenant)) return *use;
  throw not_found(name);
}

std::shared_ptr<const StoredScene> SceneStore::find(const std::string& name, const std::string& tenant) const {
  Lock hold(lock_);
  return entry(name, tenant).scene;
}

SceneUse SceneStore::use(const std::string& name, const std::string& tenant) const {
  Lock hold(lock_);
  return entry(name, tenant);
}

std::optional<SceneUse> SceneStore::use_if_there(const std::string& name, const std::string& tenant) const {
  Lock hold(lock_);
  const SceneUse* use = known(name, tenant);
  return use ? std::optional(*use) : std::nullopt;
}

Page<const StoredScene> SceneStore::list(const PageRequest& request, const std::string& tenant) const {
  std::vector<std::shared_ptr<const StoredScene>> all;
  {
    Lock hold(lock_);
    for (const auto& [name, use] : scenes_)
      if (use.scene->creator.tenant == tenant) all.push_back(use.scene);
  }
  return cut_page(std::move(all), request);
}

void SceneStore::remove(const std::string& name, const std::string& tenant) {
  SceneUse removed;  // destroyed after the lock is released
  Lock hold(lock_);
  // Other uses are only handed out under this lock, so a count of one cannot grow meanwhile.
  const SceneUse& use = entry(name, tenant);
  if (use.token.use_count() > 1)
    throw StatusError(grpc::FAILED_PRECONDITION, name + " has solves, or was added to one: delete these first");
  if (archive_) archive_->remove_scene(use.scene->number);
  requests_.remove(use.scene->creator);
  removed = std::move(scenes_.extract(name).mapped());
}

std::size_t SceneStore::count() const {
  Lock hold(lock_);
  return scenes_.size();
}

}  // namespace alvor
