#pragma once
// Test vectors that every mirror must apply alike. FILE.frames holds frames, each a length of 32 bits (little-endian) and a
// WatchSolveResponse; FILE.leaves holds the mirror's leaves afterwards, each an id of 64 bits and three float32, in order;
// FILE.errors, where errors were told, those of the leaves as float32. Where frames tell looks, FILE.submitted and FILE.edited
// hold the ReadMeshResponses of the scene as submitted and with all edits, each after its length.

#include "alvor/v1/solve_service.pb.h"
#include "solution/leaf_value.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

namespace alvor::vectors {

inline void append(std::string& bytes, const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); }

inline std::string bytes_of(const std::vector<LeafValue>& leaves) {
  std::string bytes;
  for (const LeafValue& leaf : leaves) {
    append(bytes, leaf.patch.bits());
    for (const float band : {leaf.irradiance.r, leaf.irradiance.g, leaf.irradiance.b}) append(bytes, band);
  }
  return bytes;
}

inline std::string bytes_of(std::span<const float> errors) {
  std::string bytes;
  for (const float error : errors) append(bytes, error);
  return bytes;
}

template <class Message>
std::string bytes_of(const std::vector<Message>& messages) {
  std::string bytes;
  for (const Message& message : messages) {
    append(bytes, static_cast<std::uint32_t>(message.ByteSizeLong()));
    message.AppendToString(&bytes);
  }
  return bytes;
}

inline std::string read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline std::vector<v1::WatchSolveResponse> read_frames(const std::filesystem::path& file) {
  const std::string bytes = read(file);
  std::vector<v1::WatchSolveResponse> frames;
  for (std::size_t at = 0; at + 4 <= bytes.size();) {
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + at, 4);
    if (length > bytes.size() - at - 4 || !frames.emplace_back().ParseFromArray(bytes.data() + at + 4, static_cast<int>(length)))
      return {};
    at += 4 + length;
  }
  return frames;
}

}  // namespace alvor::vectors
