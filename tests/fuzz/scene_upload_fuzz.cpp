// A scene on its way in: any messages, in any order.

#include "server/scene_upload.h"
#include "server/status_error.h"
#include "tests/fuzz/input.h"

#include <google/protobuf/stubs/logging.h>

// What is no message is told to nobody.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  google::protobuf::SetLogHandler(nullptr);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
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
      if (message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) upload.add(message);
    }
    upload.finish(store);
  } catch (const alvor::StatusError&) {}
  return 0;
}
