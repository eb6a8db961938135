#pragma once
// The server that a command talks to.

#include "client/command/options/server_option.h"
#include "client/rpc/client.h"
#include "client/rpc/in_process.h"

#include <chrono>
#include <optional>
#include <string>

namespace alvor {

/// A client, and the server behind it where that runs in this process.
class Connection {
 public:
  static constexpr std::chrono::seconds patience{5};

  /// No server chosen means one in this process. Throws Failure if a remote one does not answer within `patience`, or a file that
  /// shows who calls cannot be read.
  explicit Connection(const ServerChoice& server);

  Client& client() { return client_; }
  bool remote() const { return !local_; }

 private:
  std::optional<InProcessServer> local_;
  Client client_;
};

}  // namespace alvor
