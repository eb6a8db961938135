#pragma once
// Writes the values of a forest's leaves to a checkpoint and reads them from it.

#include "meshing/patch_forest.h"
#include "solution/plain_bytes.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace alvor {

/// Writes the values of `by_node` at `nodes`.
template <class T>
void save_at(std::span<const NodeIndex> nodes, const std::vector<T>& by_node, PlainWriter& out) {
  std::vector<T> some;
  some.reserve(nodes.size());
  for (const NodeIndex node : nodes) some.push_back(by_node[node]);
  out.put_all(some);
}

/// Reads what save_at wrote. Throws BadBytes that names `what` if is_sound(value) is false for a value: it is not finite, or out
/// of range.
template <class T, class IsSound>
void load_at(std::span<const NodeIndex> nodes, std::vector<T>& by_node, PlainReader& in, const char* what, IsSound&& is_sound) {
  const auto some = in.get_all<T>(nodes.size(), what);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (!is_sound(some[n])) throw BadBytes(std::string(what) + ": not finite or out of range");
    by_node[nodes[n]] = some[n];
  }
}

/// Writes flags of nodes, for load_flags().
inline void save_flags(std::span<const NodeIndex> nodes, const std::vector<bool>& by_node, PlainWriter& out) {
  std::vector<std::uint8_t> flags;
  for (const NodeIndex node : nodes) flags.push_back(by_node[node]);
  out.put_all(flags);
}

inline void load_flags(std::span<const NodeIndex> nodes, std::vector<bool>& by_node, PlainReader& in) {
  const auto flags = in.get_all<std::uint8_t>(nodes.size(), "flags");
  for (std::size_t n = 0; n < nodes.size(); ++n) by_node[nodes[n]] = flags[n] != 0;
}

}  // namespace alvor
