#pragma once
// Encodes the root patches of a mesh as messages of the API.

#include "alvor/v1/scene_service.pb.h"
#include "meshing/base_mesh.h"
#include "proto/codec.h"

namespace alvor {

/// Whether a MeshSlicer tells lights and objects, too.
enum class MeshParts { surfaces, all };

/// Cuts the materials, lights and objects, then the root patches of a mesh, into messages well below gRPC's limit of 4 MB. The
/// mesh must outlive it.
class MeshSlicer {
 public:
  explicit MeshSlicer(const BaseMesh& mesh, std::size_t items_at_a_time = 10'000, MeshParts parts = MeshParts::surfaces)
      : mesh_(mesh), images_(mesh.materials()), items_at_a_time_(items_at_a_time), parts_(parts) {}
  /// Fills in the next message. After the last one returns false and leaves `message` empty.
  bool next(v1::ReadMeshResponse& message);

 private:
  const BaseMesh& mesh_;
  const ImageList images_;
  const std::size_t items_at_a_time_;
  const MeshParts parts_;
  std::size_t next_ = 0, next_material_ = 0, next_light_ = 0, next_object_ = 0;
};

}  // namespace alvor
