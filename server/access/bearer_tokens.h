#pragma once
// Who may call: bearer tokens, of which only hashes are kept.

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace alvor {

/// A file of lines `NAME HASH`: HASH is the SHA-256 of a token in 64 hexadecimal digits (printf %s TOKEN | sha256sum), NAME who
/// it stands for. Empty lines and those that begin with # say nothing; a name may have several tokens.
class BearerTokens {
 public:
  /// Throws std::invalid_argument, naming the line, if it is no such file or holds no token.
  static BearerTokens parse(std::string_view text);

  /// Whose token it is.
  std::optional<std::string> holder_of(std::string_view token) const;
  /// Whose call it is by its header `authorization`, empty if it has none. Throws StatusError: UNAUTHENTICATED.
  std::string caller_of(std::string_view authorization) const;

 private:
  std::map<std::string, std::string, std::less<>> holder_by_hash_;
};

}  // namespace alvor
