#pragma once

#include <grpcpp/support/status_code_enum.h>

namespace alvor {

/// Returns the name of a status code as gRPC writes it: "INVALID_ARGUMENT".
const char* name_of(grpc::StatusCode code);

}  // namespace alvor
