#include "server/access/listening.h"

#include "server/access/bearer_tokens.h"
#include "server/base/sha256.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace alvor {
namespace {

std::string fault_of(const ListenOptions& options) {
  try {
    credentials_of(options);
    return "none";
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
}

TEST(Listening, KnowsWhoElseCouldCall) {
  for (const char* own : {"127.0.0.1:1", "127.9.9.9:0", "localhost:50051", "[::1]:50051", "unix:/tmp/alvor"})
    EXPECT_TRUE(is_loopback(own)) << own;
  for (const char* open :
       {"0.0.0.0:1", "[::]:1", "192.168.0.7:50051", "127.example.org:1", "localhost.example.org:1", "example.org:1"})
    EXPECT_FALSE(is_loopback(open)) << open;
}

TEST(Listening, PlaintextForOtherMachinesMustBeAskedFor) {
  EXPECT_NE(fault_of({.address = "0.0.0.0:0"}).find("--insecure"), std::string::npos);
  EXPECT_EQ(fault_of({.address = "0.0.0.0:0", .insecure = true}), "none");
  EXPECT_EQ(fault_of({}), "none");
}

TEST(Listening, OptionsThatContradictEachOtherAreRefused) {
  EXPECT_EQ(fault_of({.certificate = "c"}), "--tls-cert and --tls-key go together");
  EXPECT_EQ(fault_of({.client_ca = "c"}), "--tls-client-ca needs --tls-cert and --tls-key");
  EXPECT_EQ(fault_of({.address = "0.0.0.0:1", .tokens = "t", .insecure = true}),
            "--tokens needs --tls-cert and --tls-key where other machines can call: tokens are secrets");
  EXPECT_EQ(fault_of({.identity_header = "X-Who"}), "--identity-header: 'X-Who' is not of the characters a-z, 0-9 and -");
  EXPECT_EQ(fault_of({.identity_header = "authorization"}), "--identity-header: 'authorization' is taken");
  EXPECT_EQ(fault_of({.certificate = "nowhere", .key = "nowhere"}), "--tls-key: 'nowhere' cannot be read or is empty");
}

TEST(BearerTokens, HashIsThatOfTheStandard) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");  // FIPS 180-2, appendix B.1
}

TEST(BearerTokens, KnowTheirHolders) {
  const auto tokens =
      BearerTokens::parse("# who\n\nada " + sha256("one") + "\nbob " + sha256("two") + "\nada " + sha256("three") + "\n");
  EXPECT_EQ(tokens.holder_of("one"), "ada");
  EXPECT_EQ(tokens.holder_of("two"), "bob");
  EXPECT_EQ(tokens.holder_of("three"), "ada");
  EXPECT_FALSE(tokens.holder_of("four"));
  EXPECT_FALSE(tokens.holder_of(sha256("one"))) << "a hash is no token";
}

TEST(BearerTokens, BadFilesAreRefusedByLine) {
  const auto fault = [](const std::string& text) {
    try {
      BearerTokens::parse(text);
      return std::string("none");
    } catch (const std::invalid_argument& refused) {
      return std::string(refused.what());
    }
  };
  EXPECT_EQ(fault("# nobody\n"), "holds no token");
  for (const std::string& line :
       std::vector<std::string>{"ada", "ada 1234", "ada token", "ada " + sha256("x") + " more", "ada " + std::string(64, 'G')})
    EXPECT_EQ(fault("# one\n" + line + "\n").rfind("line 2: ", 0), 0u) << line;
}

}  // namespace
}  // namespace alvor
