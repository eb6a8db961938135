#pragma once
// Runs the logic of a call and turns its result or exception into a gRPC status.

#include "server/access/tenants.h"
#include "server/base/error_details.h"
#include "server/base/status_error.h"
#include "server/base/work_pool.h"

#include <grpcpp/grpcpp.h>
#include <spdlog/logger.h>

#include <algorithm>
#include <memory>
#include <new>
#include <string>

namespace alvor {

/// Returns the text with control characters replaced by blanks, so that a client's text cannot fake further lines of the log.
inline std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

/// Runs `body`. Returns OK, or the status for what it threw, which is also logged with the name `call`.
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

/// Answers a unary call whose body is quick and waits for nothing.
template <class Body>
grpc::ServerUnaryReactor* answer(grpc::CallbackServerContext* context, spdlog::logger& logger, const char* call, Body&& body) {
  grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
  reactor->Finish(attempt(logger, call, body));
  return reactor;
}

/// A unary call that stops its work when its caller leaves. Deletes itself.
class UnaryCall final : public grpc::ServerUnaryReactor {
 public:
  std::shared_ptr<CallStop> stop() const { return stop_; }

 private:
  void OnCancel() override { stop_->stop({grpc::CANCELLED, "the caller has gone"}); }
  void OnDone() override { delete this; }

  const std::shared_ptr<CallStop> stop_ = std::make_shared<CallStop>();
};

/// Answers a unary call whose body may wait for a lock or the disk. A thread of `pool` calls a copy of `body` with the tenant.
template <class Body>
grpc::ServerUnaryReactor* answer_from(WorkPool& pool, const Tenants& tenants, grpc::CallbackServerContext* context,
                                      spdlog::logger& logger, const char* call, Body body) {
  auto* reactor = new UnaryCall;
  const auto stop = reactor->stop();
  const grpc::Status refusal = attempt(logger, call, [&] {
    const std::string tenant = tenants.of(*context);
    pool.post(turn_of(tenant, *context), stop, [reactor, stop, tenant, body, &logger, call] {
      reactor->Finish(attempt(logger, call, [&] {
        stop->refuse_stopped();
        body(tenant);
      }));
    });
  });
  if (!refusal.ok()) reactor->Finish(refusal);
  return reactor;
}

/// A stream that ends with a status as soon as it begins. Deletes itself.
template <class Reactor>
class Refusal final : public Reactor {
 public:
  explicit Refusal(const grpc::Status& status) { this->Finish(status); }

 private:
  void OnDone() override { delete this; }
};

}  // namespace alvor
