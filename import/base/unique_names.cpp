#include "import/base/unique_names.h"

#include "proto/codec.h"

#include <cstdio>
#include <unordered_map>
#include <unordered_set>

namespace alvor {

namespace {

/// Returns the beginning of a name, cut between two characters.
std::string shortened(std::string name) {
  constexpr std::size_t longest = 900;
  if (name.size() <= longest) return name;
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end;  // inside a character of several bytes
  name.resize(end);
  return name;
}

std::string numbered(const std::string& name, unsigned number) {
  char text[16];
  std::snprintf(text, sizeof text, ".%03u", number);
  return name + text;
}

}  // namespace

void make_unique(std::span<std::string* const> names, const std::string& otherwise) {
  std::unordered_set<std::string> given;  // in the file: such names are not made up
  for (std::string* const name : names) {
    *name = name->empty() ? otherwise : shortened(as_utf8(*name));
    given.insert(*name);
  }
  std::unordered_set<std::string> taken;
  std::unordered_map<std::string, unsigned> last_number;
  for (std::string* const name : names) {
    if (taken.insert(*name).second) continue;
    unsigned& number = last_number[*name];
    std::string next = numbered(*name, ++number);
    while (given.contains(next) || taken.contains(next)) next = numbered(*name, ++number);
    taken.insert(next);
    *name = std::move(next);
  }
}

}  // namespace alvor
