// Tests how long a client keeps trying when its server is lost.

#include "client/rpc/client.h"
#include "server/rpc/health.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

using std::chrono::milliseconds;

class PatienceTest : public testing::Test {
 protected:
  [[noreturn]] void fail(grpc::StatusCode code) {
    ++tries;
    throw RpcError({code, ""});
  }
  HealthPort server{"127.0.0.1:0"};  // a server that accepts connections
  std::shared_ptr<grpc::Channel> channel = grpc::CreateChannel(server.address(), grpc::InsecureChannelCredentials());
  int tries = 0;
};

TEST_F(PatienceTest, LostServerIsTriedAgainUntilItAnswers) {
  const Client client(channel, std::chrono::minutes(1));
  for (const auto code : {grpc::UNAVAILABLE, grpc::CANCELLED}) {
    tries = 0;
    EXPECT_EQ(client.with_patience([&] { return tries < 3 ? (fail(code), 0) : tries; }), 3);
  }
}

TEST_F(PatienceTest, OtherFailuresAreFinal) {
  const Client client(channel, std::chrono::minutes(1));
  EXPECT_THROW(client.with_patience([&] { fail(grpc::NOT_FOUND); }), RpcError);
  EXPECT_EQ(tries, 1);
}

TEST_F(PatienceTest, ItEnds) {
  const Client client(channel, milliseconds(200));
  EXPECT_THROW(client.with_patience([&] { fail(grpc::UNAVAILABLE); }), RpcError);
  EXPECT_GT(tries, 1);
}

TEST_F(PatienceTest, ItBeginsAnewAfterEachSuccess) {
  const Client client(channel, milliseconds(1000));
  // Pauses of 50 ms take twice the 1000 ms of patience together; no single one becomes as long as that on a slow machine.
  const int needed = 40;
  const auto gets_on = [&](Client::Patience& patience) {
    patience.note_success();
    return tries < needed ? (fail(grpc::UNAVAILABLE), 0) : tries;
  };
  EXPECT_EQ(client.with_patience(gets_on), needed);
}

TEST_F(PatienceTest, ItCanBeStopped) {
  const Client client(channel, std::chrono::hours(1));
  std::stop_source stop;
  EXPECT_THROW(client.with_patience(
                   [&] {
                     stop.request_stop();
                     fail(grpc::UNAVAILABLE);
                   },
                   stop.get_token()),
               RpcError);
  EXPECT_EQ(tries, 1);
}

}  // namespace
}  // namespace alvor
