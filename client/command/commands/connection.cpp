#include "client/command/commands/connection.h"

#include "client/command/output/failure.h"
#include "import/base/whole_file.h"

namespace alvor {

namespace {

std::string read(const std::string& file) {
  if (file.empty()) return {};
  try {
    return read_whole_file(file);
  } catch (const std::exception& fault) {
    throw Failure(ExitStatus::usage, fault.what());
  }
}

std::string first_line(const std::string& text) { return text.substr(0, text.find_first_of("\r\n")); }

std::shared_ptr<grpc::ChannelCredentials> credentials_of(const ServerChoice& server) {
  if (server.ca.empty()) return grpc::InsecureChannelCredentials();
  const auto tls = grpc::SslCredentials({read(server.ca), read(server.key), read(server.certificate)});
  if (server.token_file.empty()) return tls;
  return grpc::CompositeChannelCredentials(tls, grpc::AccessTokenCredentials(first_line(read(server.token_file))));
}

// Connects to a server directly, without the web proxy of the environment. A connection that died silently is detected within 20
// s (a break of 5 s is survived: TCP resends until 6.3 s after it began). Then it is tried again every second or two, at the
// current address of the server's name.
std::shared_ptr<grpc::Channel> dial(const ServerChoice& server) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 10'000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 10'000);
  arguments.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 200);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 5'000);  // also the time limit of one attempt
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 2'000);
  arguments.SetInt(GRPC_ARG_DNS_MIN_TIME_BETWEEN_RESOLUTIONS_MS, 1'000);
  arguments.SetInt(GRPC_ARG_DNS_ARES_QUERY_TIMEOUT_MS, 1'500);  // a lost query is otherwise repeated only after 5 s
  return grpc::CreateCustomChannel(server.address, credentials_of(server), arguments);
}

std::shared_ptr<grpc::Channel> open_channel(const ServerChoice& server, std::optional<InProcessServer>& local) {
  return server.is_given() ? dial(server) : local.emplace().channel();
}

}  // namespace

Connection::Connection(const ServerChoice& server)
    : client_(open_channel(server, local_), std::chrono::milliseconds(static_cast<std::int64_t>(1000 * server.patience_s))) {
  if (remote() && !client_.wait_until_connected(patience))
    throw Failure(ExitStatus::unreachable, "the server at " + server.address + " cannot be reached");
}

}  // namespace alvor
