#include "client/command/output/failure.h"

namespace alvor {

namespace {

ExitStatus status_of(grpc::StatusCode code) {
  switch (code) {
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::CANCELLED:
    case grpc::StatusCode::DEADLINE_EXCEEDED: return ExitStatus::unreachable;
    case grpc::StatusCode::INVALID_ARGUMENT: return ExitStatus::usage;
    case grpc::StatusCode::NOT_FOUND: return ExitStatus::bad_scene;
    default: return ExitStatus::failed;
  }
}

}  // namespace

std::string reason_of(const RpcError& error) {
  const std::string text = error.what();
  const std::size_t colon = text.find(": ");
  return colon == text.npos ? text : text.substr(colon + 2);
}

Failure failure_of(const RpcError& error) {
  const ExitStatus status = status_of(error.code);
  const bool unreachable = status == ExitStatus::unreachable;
  return {status, (unreachable ? "the server cannot be reached: " : "") + reason_of(error)};
}

}  // namespace alvor
