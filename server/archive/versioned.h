#pragma once
// Blobs of the database begin with a version of their own, so that a row tells by itself how it is to be read.

#include "solution/plain_bytes.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace alvor {

/// The first byte of a blob that has a version; the second is the version. Blobs of databases before version 3 have neither: they
/// are messages, which never begin with 0 as no field has that number, or zstd frames, which begin with 0x28.
inline constexpr char version_mark = '\0';

/// Returns what `bytes` begin with when they are of `version`.
inline std::string version_prefix(std::uint8_t version) { return {version_mark, static_cast<char>(version)}; }

/// Returns what is behind the version of `blob`, or all of it where it has none: version 0 holds what version 1 does. Throws
/// BadBytes where the version is newer than `newest_known`.
inline std::string_view behind_version(std::string_view blob, std::uint8_t newest_known) {
  if (blob.size() < 2 || blob[0] != version_mark) return blob;
  const auto found = static_cast<std::uint8_t>(blob[1]);
  if (found > newest_known) throw other_version(found, newest_known);
  return blob.substr(2);
}

}  // namespace alvor
