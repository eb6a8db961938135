#include "server/base/error_details.h"

#include "alvor/v1/scene_service.pb.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "proto/codec.h"

#include <string_view>

namespace alvor {

namespace {

/// Room for names: gRPC's trailers hold at most 8 KB, of which the text takes up to 4, and details are written in base64.
constexpr std::size_t bytes_of_names = 2500;

v1::MissingFiles message_of(const std::vector<std::string>& names) {
  v1::MissingFiles message;
  std::size_t bytes = 0;
  for (const std::string& name : names) {
    bytes += name.size() + 3;
    if (bytes > bytes_of_names) break;
    message.add_names(as_utf8(name));
  }
  message.set_further_count(static_cast<std::uint32_t>(names.size()) - static_cast<std::uint32_t>(message.names_size()));
  return message;
}

}  // namespace

std::string details_of(const StatusError& refusal) {
  google::rpc::Status status;
  status.set_code(refusal.code);
  status.set_message(as_utf8(refusal.what()));
  if (refusal.code == grpc::INVALID_ARGUMENT) {
    const std::string_view text = refusal.what();
    const std::size_t place = text.find(": ");
    google::rpc::BadRequest request;
    auto& violation = *request.add_field_violations();
    if (place != std::string_view::npos) violation.set_field(as_utf8(text.substr(0, place)));
    violation.set_description(as_utf8(place == std::string_view::npos ? text : text.substr(place + 2)));
    status.add_details()->PackFrom(request);
  } else if (const auto* missing = dynamic_cast<const MissingFilesError*>(&refusal)) {
    status.add_details()->PackFrom(message_of(missing->names));
  } else if (refusal.code == grpc::UNAVAILABLE) {
    google::rpc::RetryInfo retry;
    retry.mutable_retry_delay()->set_seconds(1);
    status.add_details()->PackFrom(retry);
  } else {
    return {};
  }
  return status.SerializeAsString();
}

}  // namespace alvor
