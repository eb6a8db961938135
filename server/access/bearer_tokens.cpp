#include "server/access/bearer_tokens.h"

#include "server/base/sha256.h"
#include "server/base/status_error.h"

#include <sstream>
#include <stdexcept>

namespace alvor {

namespace {

bool is_hash(std::string_view text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace

BearerTokens BearerTokens::parse(std::string_view text) {
  BearerTokens tokens;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    std::string name, hash, more;
    if (!(words >> name) || name.starts_with('#')) continue;
    if (!(words >> hash) || !is_hash(hash) || words >> more)
      throw std::invalid_argument("line " + std::to_string(number) +
                                  ": must be a name and the SHA-256 of a token in 64 digits 0-9a-f");
    tokens.holder_by_hash_.emplace(hash, name);
  }
  if (tokens.holder_by_hash_.empty()) throw std::invalid_argument("holds no token");
  return tokens;
}

std::optional<std::string> BearerTokens::holder_of(std::string_view token) const {
  const auto found = holder_by_hash_.find(sha256(token));
  if (found == holder_by_hash_.end()) return std::nullopt;
  return found->second;
}

std::string BearerTokens::caller_of(std::string_view authorization) const {
  constexpr std::string_view scheme = "Bearer ";
  if (authorization.empty()) throw StatusError(grpc::UNAUTHENTICATED, "authorization: is missing, must be 'Bearer TOKEN'");
  auto holder = authorization.starts_with(scheme) ? holder_of(authorization.substr(scheme.size())) : std::nullopt;
  if (!holder) throw StatusError(grpc::UNAUTHENTICATED, "authorization: is not a token that this server knows");
  return *std::move(holder);
}

}  // namespace alvor
