#pragma once

#include "alvor/v1/scene_service.pb.h"

#include <cstdint>

namespace alvor {

/// An upload that can wait to be resumed after its call has ended.
class ResumableUpload {
 public:
  virtual ~ResumableUpload() = default;
  virtual std::uint64_t bytes() const = 0;
  /// Tells in `upload` what has arrived.
  virtual void describe(v1::Upload& upload) const = 0;
};

}  // namespace alvor
