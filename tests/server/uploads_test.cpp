// Tests which interrupted uploads are kept when there are too many.

#include "server/scenes/uploads.h"

#include "tests/server/refusal.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

/// Returns an upload whose first chunk has arrived.
std::unique_ptr<SceneUpload> broken_upload(int vertices = 1) {
  auto upload = std::make_unique<SceneUpload>(UploadLimits{});
  v1::CreateSceneRequest message;
  message.mutable_scene();
  upload->add(message);
  message.Clear();
  for (int n = 0; n < 3 * vertices; ++n) message.mutable_chunk()->add_vertex_coordinates(n);
  upload->add(message);
  return upload;
}

bool waits(Uploads& uploads, const Caller& caller) {
  return refusal_of(grpc::NOT_FOUND, [&] { uploads.describe(caller); }).empty();
}

/// Returns how many of `tenant`'s first `count` uploads wait to be resumed.
int waiting(Uploads& uploads, const std::string& tenant, int count) {
  int found = 0;
  for (int n = 0; n < count; ++n) found += waits(uploads, {tenant, std::to_string(n)});
  return found;
}

void break_off(Uploads& uploads, const std::string& tenant, int count, int vertices = 1) {
  for (int n = 0; n < count; ++n) uploads.put({tenant, std::to_string(n)}, broken_upload(vertices));
}

TEST(Uploads, ManyOfOneTenantEvictNoneOfAnother) {
  Uploads uploads;
  uploads.put({"ali", "hers"}, broken_upload());
  break_off(uploads, "bob", 80);
  EXPECT_TRUE(waits(uploads, {"ali", "hers"}));
  EXPECT_TRUE(waits(uploads, {"bob", "79"}));
  EXPECT_FALSE(waits(uploads, {"bob", "0"})) << "his oldest go";
  EXPECT_EQ(waiting(uploads, "bob", 80), 64);
}

TEST(Uploads, LargeOnesOfOneTenantEvictNoneOfAnother) {
  const std::uint64_t one = broken_upload(1000)->bytes();
  Uploads uploads({.bytes = 3 * one, .bytes_of_all = 6 * one});
  uploads.put({"ali", "hers"}, broken_upload(1000));
  break_off(uploads, "bob", 8, 1000);
  EXPECT_TRUE(waits(uploads, {"ali", "hers"}));
  EXPECT_EQ(waiting(uploads, "bob", 8), 3);
}

TEST(Uploads, TenantThatHasMostLosesFirstWhereAllHaveTooMany) {
  Uploads uploads({.count = 4, .count_of_all = 6});
  uploads.put({"ali", "0"}, broken_upload());
  break_off(uploads, "bob", 4);
  break_off(uploads, "cho", 2);
  EXPECT_EQ(waiting(uploads, "ali", 1), 1) << "the oldest of all, and her only one";
  EXPECT_EQ(waiting(uploads, "bob", 4), 3);
  EXPECT_EQ(waiting(uploads, "cho", 2), 2);
}

TEST(Uploads, TenantWithMostBytesLosesFirstWhereAllAreTooLarge) {
  const std::uint64_t one = broken_upload(1000)->bytes();
  Uploads uploads({.bytes = 4 * one, .bytes_of_all = 5 * one});
  break_off(uploads, "ali", 8);  // many, but small
  break_off(uploads, "bob", 3, 1000);
  break_off(uploads, "cho", 2, 1000);
  EXPECT_EQ(waiting(uploads, "ali", 8), 8);
  EXPECT_EQ(waiting(uploads, "bob", 3), 2);
  EXPECT_EQ(waiting(uploads, "cho", 2), 2);
}

}  // namespace
}  // namespace alvor
