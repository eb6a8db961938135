#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace alvor {

/// Of bytes that come one part after the other (FIPS 180-4).
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  void add(std::string_view bytes);
  /// In lower-case hexadecimal digits. Nothing can be added afterwards.
  std::string digits();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// In lower-case hexadecimal digits.
std::string sha256(std::string_view bytes);

}  // namespace alvor
