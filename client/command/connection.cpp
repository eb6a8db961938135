#include "client/command/connection.h"

#include "client/command/failure.h"

namespace alvor {

namespace {

// Servers are named directly: a proxy meant for the web would only be in the way.
std::shared_ptr<grpc::Channel> dial(const std::string& address) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
}

std::shared_ptr<grpc::Channel> open_channel(const std::string& address, std::optional<InProcessServer>& local) {
  return address.empty() ? local.emplace().channel() : dial(address);
}

}  // namespace

Connection::Connection(const std::string& address) : client_(open_channel(address, local_)) {
  if (remote() && !client_.wait_until_connected(patience))
    throw Failure(ExitStatus::unreachable, "the server at " + address + " cannot be reached");
}

}  // namespace alvor
