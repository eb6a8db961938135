#pragma once
// The scenes that a server holds.

#include "alvor/v1/scene_service.pb.h"
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
#include <string>

namespace alvor {

struct SceneContent {
  Scene scene;    ///< as it was submitted
  BaseMesh mesh;  ///< at least one root
};

/// Content by its hash: while anyone uses it there is one of it in memory. Thread-safe.
class SceneContents {
 public:
  explicit SceneContents(Archive* archive) : archive_(archive) {}
  std::shared_ptr<const SceneContent> add(const std::string& sha256, Scene scene, BaseMesh mesh);
  /// Loaded where it is not in memory, once for all who ask at a time. Throws StatusError, also when `stop` says so.
  std::shared_ptr<const SceneContent> find(const std::string& sha256, const CallStop& stop);

 private:
  std::shared_ptr<const SceneContent> known(const std::string& sha256);
  /// Held by who loads that content.
  std::shared_ptr<Mutex> loading(const std::string& sha256);

  Archive* const archive_;
  Mutex lock_;
  std::map<std::string, std::weak_ptr<Mutex>> loading_ ALVOR_GUARDED_BY(lock_);
  std::map<std::string, std::weak_ptr<const SceneContent>> known_ ALVOR_GUARDED_BY(lock_);
};

/// Immutable once stored; safe to read from any thread.
class StoredScene {
 public:
  StoredScene(std::uint64_t scene_number, Caller caller, v1::Scene scene_facts, SceneContents& contents,
              std::shared_ptr<const SceneContent> kept)
      : number(scene_number),
        creator(std::move(caller)),
        facts(std::move(scene_facts)),
        contents_(contents),
        kept_(std::move(kept)) {}

  const std::uint64_t number;
  const Caller creator;
  const v1::Scene facts;  ///< as the API tells them

  /// Throws StatusError where it has to be loaded and cannot be, or `stop` says so.
  std::shared_ptr<const SceneContent> content(const CallStop& stop = {}) const {
    return kept_ ? kept_ : contents_.find(facts.content_sha256(), stop);
  }

 private:
  SceneContents& contents_;
  const std::shared_ptr<const SceneContent> kept_;  ///< where there is no archive
};

/// A scene that cannot be deleted while any copy of this exists.
struct SceneUse {
  std::shared_ptr<const StoredScene> scene;
  std::shared_ptr<const int> token;
};

/// Thread-safe. Throws StatusError. Scenes of other tenants than the caller are NOT_FOUND.
class SceneStore {
 public:
  /// Begins with the scenes of the archive, if there is one, and keeps all others there. It must outlive the store.
  explicit SceneStore(Archive* archive = nullptr, const Quota& quota = {}, MemoryGuard memory = MemoryGuard());

  /// INVALID_ARGUMENT names what is wrong with the scene, RESOURCE_EXHAUSTED says of what there is too much. The mesh is built on
  /// the calling thread, unless `stop` ends it. The same request again gets the same scene. When it returns the scene is kept.
  std::shared_ptr<const StoredScene> add(Scene scene, const std::string& display_name, const Caller& caller = {},
                                         const CallStop& stop = {});
  /// NOT_FOUND.
  std::shared_ptr<const StoredScene> find(const std::string& name, const std::string& tenant = {}) const;
  SceneUse use(const std::string& name, const std::string& tenant = {}) const;
  Page<const StoredScene> list(const PageRequest& request, const std::string& tenant = {}) const;
  /// NOT_FOUND; FAILED_PRECONDITION while it is in use.
  void remove(const std::string& name, const std::string& tenant = {});
  std::size_t count() const;

 private:
  const SceneUse& entry(const std::string& name, const std::string& tenant) const ALVOR_REQUIRES(lock_);
  std::shared_ptr<const StoredScene> repeated(const Caller& caller, const v1::Scene& facts) const;
  void check_quota(const std::string& tenant, std::uint64_t bytes) const;
  void insert(std::shared_ptr<const StoredScene> scene);

  Archive* const archive_;
  const Quota quota_;
  const MemoryGuard memory_;
  mutable SceneContents contents_;
  Mutex adding_;  ///< one scene is written at a time
  mutable Mutex lock_;
  std::map<std::string, SceneUse> scenes_ ALVOR_GUARDED_BY(lock_);
  RequestIds requests_ ALVOR_GUARDED_BY(lock_);
  std::uint64_t next_number_ ALVOR_GUARDED_BY(adding_) = 1;
};

}  // namespace alvor
