#pragma once
// How a command ends when it cannot do what was asked.

#include "client/rpc/client.h"

#include <stdexcept>
#include <string>

namespace alvor {

/// The exit statuses that users and scripts rely on.
enum class ExitStatus { done = 0, usage = 2, bad_scene = 3, unreachable = 4, failed = 5 };

/// Ends the command. what() is one line for people.
struct Failure : std::runtime_error {
  Failure(ExitStatus exit_status, const std::string& line) : std::runtime_error(line), status(exit_status) {}
  ExitStatus status;
};

/// What the server said, without the name of the code.
std::string reason_of(const RpcError& error);

/// What a refused or lost call means for the user of the command.
Failure failure_of(const RpcError& error);

}  // namespace alvor
