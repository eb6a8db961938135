#pragma once
// Exceptions with a gRPC status, thrown by the logic behind the calls to refuse a request.

#include <grpcpp/support/status.h>

#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace alvor {

/// A refusal with its gRPC status. The text is cut after 1000 bytes: it may quote what a client sent, and gRPC's trailers hold at
/// most 8 KB.
struct StatusError : std::runtime_error {
  StatusError(grpc::StatusCode status_code, const std::string& text)
      : std::runtime_error(text.substr(0, 1000)), code(status_code) {}
  grpc::StatusCode code;
};

/// Tells which files of a scene were not sent.
struct MissingFilesError : StatusError {
  MissingFilesError(const std::string& scene, std::vector<std::string> missing)
      : StatusError(grpc::FAILED_PRECONDITION, text_of(scene, missing)), names(std::move(missing)) {}
  std::vector<std::string> names;

 private:
  static std::string text_of(const std::string& scene, const std::vector<std::string>& missing) {
    std::string text = scene + ": needs files that were not sent";
    for (std::size_t n = 0; n < missing.size(); ++n) text += (n == 0 ? ": " : ", ") + missing[n];
    return text;
  }
};

inline StatusError not_found(const std::string& name) {
  return {grpc::NOT_FOUND, name.empty() ? "the name is empty" : name + " does not exist"};
}
inline StatusError invalid_argument(const std::string& text) { return {grpc::INVALID_ARGUMENT, text}; }
/// Returns the refusal of a request whose `field` has this value.
template <class Value>
StatusError invalid_field(const std::string& field, const Value& value, const std::string& reason) {
  std::ostringstream text;
  text << field << ": " << value << " " << reason;
  return invalid_argument(text.str());
}

}  // namespace alvor
