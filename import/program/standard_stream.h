#pragma once

#include "import/apart/records.h"

namespace alvor {

/// Records that come from stdin and go to stdout.
class StandardStream : public RecordStream {
 private:
  std::size_t read_some(char* bytes, std::size_t size) override;
  std::size_t write_some(const char* bytes, std::size_t size) override;
};

}  // namespace alvor
