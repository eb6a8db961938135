#pragma once
// The scenes that a server holds, in memory.

#include "alvor/v1/scene_service.pb.h"
#include "meshing/base_mesh.h"
#include "server/paging.h"

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace alvor {

/// Immutable once stored; safe to read from any thread.
struct StoredScene {
  std::uint64_t number;
  v1::Scene facts;  ///< as the API tells them
  Scene scene;      ///< as it was submitted
  BaseMesh mesh;    ///< at least one root
};

/// A scene that cannot be deleted while any copy of this exists.
struct SceneUse {
  std::shared_ptr<const StoredScene> scene;
  std::shared_ptr<const int> token;
};

/// Thread-safe. Throws StatusError.
class SceneStore {
 public:
  /// INVALID_ARGUMENT names what is wrong with the scene. The mesh is built on the calling thread.
  std::shared_ptr<const StoredScene> add(Scene scene, const std::string& display_name);
  /// NOT_FOUND.
  std::shared_ptr<const StoredScene> find(const std::string& name) const;
  SceneUse use(const std::string& name) const;
  Page<const StoredScene> list(const PageRequest& request) const;
  /// NOT_FOUND; FAILED_PRECONDITION while it is in use.
  void remove(const std::string& name);

 private:
  const SceneUse& entry(const std::string& name) const;

  mutable std::mutex lock_;
  std::map<std::string, SceneUse> scenes_;
  std::uint64_t next_number_ = 1;
};

}  // namespace alvor
