#pragma once
// Exit statuses, and the exception that ends a command.

#include "client/rpc/client.h"

#include <stdexcept>
#include <string>

namespace alvor {

/// The exit statuses that users and scripts rely on.
enum class ExitStatus { done = 0, usage = 2, bad_scene = 3, unreachable = 4, failed = 5 };

/// Ends the command with an exit status. what() is one line for people.
struct Failure : std::runtime_error {
  Failure(ExitStatus exit_status, const std::string& line) : std::runtime_error(line), status(exit_status) {}
  ExitStatus status;
};

/// Returns the server's message without the name of the status code.
std::string reason_of(const RpcError& error);

/// Returns the failure, with its exit status, for a refused or lost call.
Failure failure_of(const RpcError& error);

}  // namespace alvor
