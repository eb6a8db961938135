#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace alvor {

/// Computes the SHA-256 of bytes that come in parts (FIPS 180-4).
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  void add(std::string_view bytes);
  /// Returns the hash in lower-case hexadecimal digits. Nothing can be added afterwards.
  std::string digits();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// Returns the SHA-256 of `bytes` in lower-case hexadecimal digits.
std::string sha256(std::string_view bytes);

}  // namespace alvor
