#pragma once
// What one browser, and all of them together, may take of the server.

#include <chrono>
#include <cstddef>

namespace alvor {

/// Beyond a limit a request is refused or its connection closed; each limit says which. The defaults leave an ordinary page
/// (six connections, headers of 1 KiB) a factor of ten.
struct WebLimits {
  using Time = std::chrono::milliseconds;

  std::size_t header_bytes = 16 << 10;          ///< request line and headers; also what is read ahead. Status 431
  std::size_t header_lines = 100;               ///< request line included. Status 431
  std::size_t chunk_line_bytes = 1024;          ///< a chunk's size with its extensions, or all trailers. Status 400
  std::size_t message_bytes = 64 << 20;         ///< a message of gRPC-Web. RESOURCE_EXHAUSTED
  std::size_t unfinished_bytes = 256 << 20;     ///< parts of messages, of all connections together. RESOURCE_EXHAUSTED
  std::size_t unwanted_bytes = 64 << 20;        ///< of a body whose call has failed already. Status 400, or 401 without a token
  std::size_t connections = 1024;               ///< in all; beyond it see WebAdmission
  std::size_t connections_of_one_address = 64;  ///< of one IPv4 address or IPv6 /64; Unix sockets have no address

  Time handshake = std::chrono::seconds(10);  ///< of TLS. The connection is closed
  Time headers = std::chrono::seconds(10);    ///< from a connection's beginning, later from a request's first byte. Status 408
  Time idle = std::chrono::seconds(30);       ///< between two requests. The connection is closed
  Time message = std::chrono::seconds(60);    ///< for a message to come as a whole (408), and for the server to take it (503)
  Time write = std::chrono::seconds(60);      ///< without a byte taken by the browser. The connection is closed
  Time farewell = std::chrono::seconds(1);    ///< for the browser to read a refusal before the connection is closed
  std::size_t farewell_bytes = 4 << 20;       ///< of its request that are read and dropped meanwhile
  Time stop = std::chrono::seconds(1);        ///< for responses under way when the front is destroyed
  Time no_descriptors = std::chrono::milliseconds(100);  ///< until connections are accepted again after EMFILE or ENFILE
};

}  // namespace alvor
