#pragma once
// Converts between the records of scenes and solves, the messages of the API, and the bytes that the archive keeps of them.

#include "alvor/v1/scene_service.pb.h"
#include "alvor/v1/solve_service.pb.h"
#include "server/archive/scene_record.h"
#include "server/archive/solve_record.h"

#include <string>
#include <string_view>

namespace alvor {

/// Returns the name of the status in the API: "QUEUED", ...
std::string_view text(SolveStatus status);

v1::Scene encode(const SceneRecord& record);
SceneRecord decode(const v1::Scene& message);

v1::SolveSpec encode(const SolveSpec& spec);
/// Throws StatusError INVALID_ARGUMENT that names the field if an enumerator is not known to this build or a duration is not one.
SolveSpec decode(const v1::SolveSpec& message);

v1::Solve encode(const SolveRecord& record);
/// Throws as the decode() of a spec does.
SolveRecord decode(const v1::Solve& message);

/// These return the record as the archive keeps it: the version of the format, then the message of the API.
std::string facts_of(const SceneRecord& record);
std::string facts_of(const SolveRecord& record);
/// These return the record that facts_of() wrote, in this build or an older one. They throw StatusError, DATA_LOSS if `facts` is
/// damaged or of a newer version.
SceneRecord scene_of(std::string_view facts);
SolveRecord solve_of(std::string_view facts);

}  // namespace alvor
