#pragma once

#include "meshing/scene.h"

#include <cstdint>
#include <optional>
#include <string>

namespace alvor {

/// Makes the objects of an OBJ file from its lines `o` and `g`: a group is an object that hangs from the object around it. What
/// has no faces becomes no object, unless a group hangs from it; a group that is left and entered again becomes two objects.
class ObjObjects {
 public:
  explicit ObjObjects(Scene& scene) : scene_(scene) {}

  /// Begins an object, and ends the group before it.
  void begin_object(std::string name) {
    object_name_ = std::move(name);
    object_.reset();
    begin_group({});
  }
  /// Begins a group, and ends the one before it; an empty name only does that.
  void begin_group(std::string name) {
    if (name == group_name_) return;
    group_name_ = std::move(name);
    group_.reset();
  }
  /// Called before a face is added.
  void before_face();
  /// Called after a face was added.
  void after_face();

 private:
  Scene& scene_;
  std::string object_name_, group_name_;
  std::optional<std::uint32_t> object_, group_;  // their numbers, once they were made
  std::optional<std::uint32_t> current_;         // takes the next face
};

}  // namespace alvor
