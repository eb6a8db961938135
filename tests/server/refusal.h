#pragma once

#include "server/base/status_error.h"

#include <string>

namespace alvor {

/// The text with which `call` is refused; "" if it is not, and a remark if the code is another than `code`.
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
