#pragma once
// Checks bearer tokens; the server keeps only their hashes.

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace alvor {

/// The tokens of a file with lines `NAME HASH`: NAME is the caller, HASH the SHA-256 of its token in 64 hexadecimal digits
/// (printf %s TOKEN | sha256sum). Empty lines and lines that begin with # are ignored. A name may have several tokens.
class BearerTokens {
 public:
  /// Reads such a file. Throws std::invalid_argument, naming the line, if the text is malformed or holds no token.
  static BearerTokens parse(std::string_view text);

  /// Returns the name whose token it is, or nothing.
  std::optional<std::string> holder_of(std::string_view token) const;
  /// Returns the caller's name for the header `authorization` (empty if the call has none). Throws StatusError UNAUTHENTICATED.
  std::string caller_of(std::string_view authorization) const;

 private:
  std::map<std::string, std::string, std::less<>> holder_by_hash_;
};

}  // namespace alvor
