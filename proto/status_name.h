#pragma once

#include <grpcpp/support/status_code_enum.h>

namespace alvor {

/// As gRPC writes it: "INVALID_ARGUMENT".
const char* name_of(grpc::StatusCode code);

}  // namespace alvor
