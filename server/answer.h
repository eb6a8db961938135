#pragma once
// From what a call's logic does or throws to what gRPC is told.

#include "server/error_details.h"
#include "server/status_error.h"

#include <grpcpp/grpcpp.h>
#include <spdlog/logger.h>

#include <algorithm>
#include <new>

namespace alvor {

/// For the log: a client's text must not fake further lines.
inline std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

/// Runs `body`; what it throws becomes the status, and a line in the log. `call` is for that line.
template <class Body>
grpc::Status attempt(spdlog::logger& logger, const char* call, Body&& body) {
  try {
    body();
    return grpc::Status::OK;
  } catch (const StatusError& refusal) {
    logger.info("refused {}: {}", call, one_line(refusal.what()));
    return {refusal.code, refusal.what(), details_of(refusal)};
  } catch (const std::bad_alloc&) {
    logger.error("refused {}: out of memory", call);
    return {grpc::RESOURCE_EXHAUSTED, "the server is out of memory"};
  } catch (const std::exception& fault) {
    logger.error("{} failed: {}", call, fault.what());
    return {grpc::INTERNAL, fault.what()};
  }
}

/// The whole of a unary call.
template <class Body>
grpc::ServerUnaryReactor* answer(grpc::CallbackServerContext* context, spdlog::logger& logger, const char* call, Body&& body) {
  grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
  reactor->Finish(attempt(logger, call, body));
  return reactor;
}

}  // namespace alvor
