#include "import/formats/obj_objects.h"

#include "import/formats/placement.h"

namespace alvor {

void ObjObjects::before_face() {
  if (!group_name_.empty()) {
    if (!object_ && !object_name_.empty()) object_ = add_object(scene_, object_name_, std::nullopt, {});
    if (!group_) group_ = add_object(scene_, group_name_, object_, {});
    current_ = group_;
    return;
  }
  // An object takes no more faces after its groups: they would lie behind those of the groups.
  const bool has_groups = object_ && *object_ + 1 < scene_.objects.size();
  if (!object_name_.empty() && (!object_ || has_groups)) object_ = add_object(scene_, object_name_, std::nullopt, {});
  current_ = object_;
}

void ObjObjects::after_face() {
  if (current_) take_new_faces(scene_, *current_);
}

}  // namespace alvor
