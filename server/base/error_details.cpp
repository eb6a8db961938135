#include "server/base/error_details.h"

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "proto/codec.h"

#include <string_view>

namespace alvor {

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
