// Fuzzes scene uploads: any messages, in any order.

#include "server/base/status_error.h"
#include "server/scenes/scene_upload.h"
#include "tests/fuzz/allocation_limit.h"
#include "tests/fuzz/input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr std::size_t largest_allocation = 16 << 20;  // a scene and its acceleration structure are made of it
  alvor::fuzz::Input input(data, size);
  alvor::SceneStore store;
  alvor::UploadLimits limits;
  limits.bytes = 1 << 20;
  limits.corners = 10'000;
  alvor::SceneUpload upload(limits);
  try {
    while (!input.empty()) {
      alvor::v1::CreateSceneRequest message;
      const auto bytes = input.text();
      if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) continue;
      const alvor::fuzz::AllocationLimit limit(largest_allocation);
      upload.add(message);
    }
    const alvor::fuzz::AllocationLimit limit(largest_allocation);
    upload.finish(store);
  } catch (const alvor::StatusError&) {}
  return 0;
}
