#pragma once
// Details of an error that programs can read.

#include "server/base/status_error.h"

#include <string>

namespace alvor {

/// Returns a serialized google.rpc.Status: for INVALID_ARGUMENT with a BadRequest.FieldViolation that names the place, for
/// UNAVAILABLE with a RetryInfo, for MissingFilesError with MissingFiles. Empty for other codes, whose message is enough.
std::string details_of(const StatusError& refusal);

}  // namespace alvor
