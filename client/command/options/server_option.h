#pragma once
// Which server a command talks to, and how it shows who it is.

#include <CLI/CLI.hpp>

#include <string>

namespace alvor {

struct ServerChoice {
  std::string address;           ///< HOST:PORT; empty: none
  std::string ca;                ///< PEM file of who signs servers' certificates: TLS
  std::string certificate, key;  ///< PEM files, where the server asks for them
  std::string token_file;        ///< its first line is sent with every call
  double patience_s = 300;       ///< with a server that was lost
  bool is_given() const { return !address.empty(); }
};

/// --server and what goes with it. Returns --server.
CLI::Option& add_server_option(CLI::App& command, ServerChoice& server, const std::string& description);

}  // namespace alvor
