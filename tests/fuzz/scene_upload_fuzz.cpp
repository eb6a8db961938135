// Fuzzes uploads of scenes and of scene files: any messages, in any order. The first byte says which.

#include "server/base/status_error.h"
#include "server/scenes/file_upload.h"
#include "server/scenes/scene_upload.h"
#include "tests/fuzz/allocation_limit.h"
#include "tests/fuzz/input.h"

#include <cstdlib>

namespace alvor::fuzz {
namespace {

constexpr std::size_t largest_allocation = 16 << 20;  // a scene and its acceleration structure are made of it

UploadLimits small_limits() {
  UploadLimits limits;
  limits.bytes = 1 << 20;
  limits.corners = 10'000;
  return limits;
}

template <class Message, class Take>
void for_each_message(Input& input, Take&& take) {
  while (!input.empty()) {
    Message message;
    const auto bytes = input.text();
    if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) continue;
    const AllocationLimit limit(largest_allocation);
    take(message);
  }
}

void upload_scene(Input& input) {
  SceneStore store;
  SceneUpload upload(small_limits());
  for_each_message<v1::CreateSceneRequest>(input, [&](const auto& message) { upload.add(message); });
  const AllocationLimit limit(largest_allocation);
  upload.finish(store);
}

/// Reading the files is a program of its own: the target `file` fuzzes it.
void upload_files(Input& input) {
  FileUpload upload(small_limits());
  bool is_begun = false;
  for_each_message<v1::ImportSceneRequest>(input, [&](const auto& message) {
    is_begun ? upload.add(message) : upload.begin(message);
    is_begun = true;
    v1::Upload described;
    upload.describe(described);
    constexpr std::uint64_t of_names = 10'000 * 200;  // most files, and what each counts besides its content
    if (upload.bytes() > small_limits().bytes + of_names) std::abort();
  });
}

}  // namespace
}  // namespace alvor::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  alvor::fuzz::Input input(data, size);
  try {
    if (input.byte() % 2 == 0) alvor::fuzz::upload_scene(input);
    else alvor::fuzz::upload_files(input);
  } catch (const alvor::StatusError&) {}
  return 0;
}
