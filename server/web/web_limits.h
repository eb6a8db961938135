#pragma once
// Limits on the resources that one browser, and all of them together, may use.

#include <chrono>
#include <cstddef>

namespace alvor {

/// A request beyond a limit is refused, or its connection closed; each limit says which. The defaults are ten times what an
/// ordinary page needs (six connections, headers of 1 KiB).
struct WebLimits {
  using Time = std::chrono::milliseconds;

  std::size_t header_bytes = 16 << 10;          ///< request line and headers; also bytes read ahead. Status 431
  std::size_t header_lines = 100;               ///< lines of the head with the request line. Status 431
  std::size_t chunk_line_bytes = 1024;          ///< a chunk's size line, or all trailers together. Status 400
  std::size_t message_bytes = 64 << 20;         ///< one gRPC-Web message. RESOURCE_EXHAUSTED
  std::size_t unfinished_bytes = 256 << 20;     ///< incomplete messages of all connections together. RESOURCE_EXHAUSTED
  std::size_t unwanted_bytes = 64 << 20;        ///< rest of a body whose call has failed. Status 400, or 401 without a token
  std::size_t connections = 1024;               ///< connections in all; beyond it see WebAdmission
  std::size_t connections_of_one_address = 64;  ///< from one IPv4 address or IPv6 /64; Unix sockets have no address

  Time handshake = std::chrono::seconds(10);  ///< for the TLS handshake; then the connection is closed
  Time headers = std::chrono::seconds(10);    ///< for the head, from connecting or from the request's first byte. Status 408
  Time idle = std::chrono::seconds(30);       ///< between two requests; then the connection is closed
  Time message = std::chrono::seconds(60);    ///< for a whole message to arrive (408), and for the server to take it (503)
  Time write = std::chrono::seconds(60);      ///< without a byte taken by the browser; then the connection is closed
  Time farewell = std::chrono::seconds(1);    ///< for the browser to read a refusal before the connection is closed
  std::size_t farewell_bytes = 4 << 20;       ///< bytes of the refused request that are read and dropped meanwhile
  Time stop = std::chrono::seconds(1);        ///< for responses under way when the front is destroyed
  Time no_descriptors = std::chrono::milliseconds(100);  ///< pause in accepting after EMFILE or ENFILE
};

}  // namespace alvor
