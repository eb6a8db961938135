#pragma once
// The scenes that a server holds, by name, and their content.

#include "meshing/base_mesh.h"
#include "server/archive/archive.h"
#include "server/base/memory_guard.h"
#include "server/base/mutex.h"
#include "server/base/paging.h"
#include "server/base/request_ids.h"
#include "server/base/work_pool.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alvor {

struct SceneContent;
/// Contents of scenes that edits have added as objects, by resource name. None is null.
using AddedContents = std::map<std::string, std::shared_ptr<const SceneContent>>;

struct SceneContent {
  Scene scene;    ///< as it was submitted, or as edits have made it
  BaseMesh mesh;  ///< at least one root
  /// The content before all edits; null if `scene` is as submitted.
  std::shared_ptr<const SceneContent> submitted = nullptr;
  AddedContents added = {};  ///< of all scenes that edits have ever added
};

/// The content of scenes by its hash. Content in use is in memory once. Thread-safe.
class SceneContents {
 public:
  explicit SceneContents(Archive* archive) : archive_(archive) {}
  std::shared_ptr<const SceneContent> add(const std::string& sha256, Scene scene, BaseMesh mesh);
  /// Returns the content. Loads it if it is not in memory, once for all who ask at the same time. Throws StatusError, also the
  /// reason of `stop`.
  std::shared_ptr<const SceneContent> find(const std::string& sha256, const CallStop& stop);

 private:
  std::shared_ptr<const SceneContent> known(const std::string& sha256);
  /// Returns the lock that is held while that content is loaded.
  std::shared_ptr<Mutex> loading(const std::string& sha256);

  Archive* const archive_;
  Mutex lock_;
  std::map<std::string, std::weak_ptr<Mutex>> loading_ ALVOR_GUARDED_BY(lock_);
  std::map<std::string, std::weak_ptr<const SceneContent>> known_ ALVOR_GUARDED_BY(lock_);
};

/// Immutable once stored; safe to read from any thread.
class StoredScene {
 public:
  StoredScene(std::uint64_t scene_number, Caller caller, SceneRecord scene_facts, SceneContents& contents,
              std::shared_ptr<const SceneContent> kept)
      : number(scene_number),
        creator(std::move(caller)),
        facts(std::move(scene_facts)),
        contents_(contents),
        kept_(std::move(kept)) {}

  const std::uint64_t number;
  const Caller creator;
  const SceneRecord facts;

  /// Returns the scene's content. Throws StatusError if it must be loaded and cannot be, or for the reason of `stop`.
  std::shared_ptr<const SceneContent> content(const CallStop& stop = {}) const {
    return kept_ ? kept_ : contents_.find(facts.content_sha256, stop);
  }

 private:
  SceneContents& contents_;
  const std::shared_ptr<const SceneContent> kept_;  ///< set where there is no archive
};

/// A reference to a scene: while any copy of it exists, the scene cannot be deleted.
struct SceneUse {
  std::shared_ptr<const StoredScene> scene;
  std::shared_ptr<const int> token;
};

/// Stores scenes by name. Thread-safe. Throws StatusError. A scene of another tenant than the caller's is NOT_FOUND.
class SceneStore {
 public:
  /// Loads the scenes of `archive` (may be null) and stores all later ones there. The archive must outlive the store.
  explicit SceneStore(Archive* archive = nullptr, const Quota& quota = {}, MemoryGuard memory = MemoryGuard());

  /// Stores a scene and returns it. INVALID_ARGUMENT names the fault in the scene; RESOURCE_EXHAUSTED names the limit or quota
  /// that is exceeded. The mesh is built on the calling thread unless `stop` ends it. A repeated request returns the same scene.
  /// The scene is in the archive when this returns. `warnings` are told with it, before those about the scene.
  std::shared_ptr<const StoredScene> add(Scene scene, const std::string& display_name, const Caller& caller = {},
                                         const CallStop& stop = {}, std::vector<std::string> warnings = {});
  /// Returns the scene of this name. Throws NOT_FOUND.
  std::shared_ptr<const StoredScene> find(const std::string& name, const std::string& tenant = {}) const;
  SceneUse use(const std::string& name, const std::string& tenant = {}) const;
  /// As use(), but returns nothing where that throws NOT_FOUND.
  std::optional<SceneUse> use_if_there(const std::string& name, const std::string& tenant) const;
  Page<const StoredScene> list(const PageRequest& request, const std::string& tenant = {}) const;
  /// Deletes the scene. Throws NOT_FOUND, or FAILED_PRECONDITION while it is in use.
  void remove(const std::string& name, const std::string& tenant = {});
  std::size_t count() const;

 private:
  const SceneUse* known(const std::string& name, const std::string& tenant) const ALVOR_REQUIRES(lock_);
  const SceneUse& entry(const std::string& name, const std::string& tenant) const ALVOR_REQUIRES(lock_);
  std::shared_ptr<const StoredScene> repeated(const Caller& caller, const SceneRecord& facts) const;
  void check_quota(const std::string& tenant, std::uint64_t bytes) const;
  void insert(std::shared_ptr<const StoredScene> scene);

  Archive* const archive_;
  const Quota quota_;
  const MemoryGuard memory_;
  mutable SceneContents contents_;
  Mutex adding_;  ///< held while a scene is written: one at a time
  mutable Mutex lock_;
  std::map<std::string, SceneUse> scenes_ ALVOR_GUARDED_BY(lock_);
  RequestIds requests_ ALVOR_GUARDED_BY(lock_);
  std::uint64_t next_number_ ALVOR_GUARDED_BY(adding_) = 1;
};

}  // namespace alvor
