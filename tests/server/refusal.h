#pragma once

#include "server/base/status_error.h"

#include <string>

namespace alvor {

/// Returns the text with which `call` is refused, "" if it is not, or a remark if the status is not `code`.
template <class Call>
std::string refusal_of(grpc::StatusCode code, Call&& call) {
  try {
    call();
  } catch (const StatusError& refusal) {
    return refusal.code == code ? refusal.what() : "(code " + std::to_string(refusal.code) + ") " + refusal.what();
  }
  return "";
}

}  // namespace alvor
