#pragma once
// Connects a command to a server.

#include "client/command/options/server_option.h"
#include "client/rpc/client.h"
#include "client/rpc/in_process.h"

#include <chrono>
#include <optional>
#include <string>

namespace alvor {

/// A client and, if no server was chosen, a server in this process.
class Connection {
 public:
  static constexpr std::chrono::seconds patience{5};

  /// Connects to `server`, or to a new server in this process if none was chosen. Throws Failure if a remote server does not
  /// answer within `patience`, or a file of credentials cannot be read.
  explicit Connection(const ServerChoice& server);

  Client& client() { return client_; }
  bool remote() const { return !local_; }

 private:
  std::optional<InProcessServer> local_;
  Client client_;
};

}  // namespace alvor
