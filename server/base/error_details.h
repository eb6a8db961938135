#pragma once
// What a refusal says to programs.

#include "server/base/status_error.h"

#include <string>

namespace alvor {

/// A serialized google.rpc.Status: of INVALID_ARGUMENT with the place as a BadRequest.FieldViolation, of UNAVAILABLE with a
/// RetryInfo. Empty for other codes, whose message says all.
std::string details_of(const StatusError& refusal);

}  // namespace alvor
