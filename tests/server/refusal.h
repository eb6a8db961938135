#pragma once

#include "client/rpc/client.h"
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

/// Returns the text with which a client's call is refused, "" if it is not.
template <class Call>
std::string error_of(Call&& call) {
  try {
    call();
  } catch (const RpcError& error) {
    return error.what();
  }
  return "";
}

}  // namespace alvor
