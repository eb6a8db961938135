#pragma once
// Options that choose a server and the caller's credentials.

#include <CLI/CLI.hpp>

#include <string>

namespace alvor {

struct ServerChoice {
  std::string address;           ///< HOST:PORT; empty: no server
  std::string ca;                ///< PEM file of the CA that signed the server's certificate; given means TLS
  std::string certificate, key;  ///< PEM files of the client, if the server asks for them
  std::string token_file;        ///< its first line is sent with every call
  double patience_s = 300;       ///< how long a lost server is waited for
  bool is_given() const { return !address.empty(); }
};

/// Adds --server and the options that belong to it. Returns --server.
CLI::Option& add_server_option(CLI::App& command, ServerChoice& server, const std::string& description);

}  // namespace alvor
