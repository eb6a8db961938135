// The one-definition rule: a name of namespace alvor means one thing in all files that are linked together.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace {

namespace fs = std::filesystem;

/// Returns the types and functions that a file defines at the level of a named namespace. clang-format keeps such lines at the
/// first column, and ends each unnamed namespace with a comment that says so.
std::set<std::string> definitions(const fs::path& file) {
  const std::regex type(
      R"(^(?:template <.*> ?)?(?:struct|class|enum class|enum|union) (?:\[\[\w+\]\] |alignas\([^)]*\) )?(\w+)(?: final)?(?: : .*)? ?\{.*)");
  const std::regex function(R"(^(?=\w)(?:inline |constexpr )*[\w:<>,&* ]+[ &*](\w+\(.*\))(?: const| noexcept)* \{.*)");
  const std::regex opening(R"(^namespace ?([\w:]*) ?\{$)"), closing(R"(^\}  // namespace ?([\w:]*)$)");
  std::set<std::string> found;
  std::string space;
  int unnamed = 0;
  std::smatch match;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (std::regex_match(line, match, opening)) {
      if (match[1].length() == 0) ++unnamed;
      else space = match[1];
    } else if (std::regex_match(line, match, closing)) {
      if (match[1].length() == 0) --unnamed;
    } else if (unnamed == 0 && std::regex_match(line, match, type)) {
      found.insert("type " + space + "::" + match[1].str());
    } else if (unnamed == 0 && !line.starts_with("static ") && std::regex_match(line, match, function)) {
      found.insert("function " + space + "::" + match[1].str());
    }
  }
  return found;
}

bool is_program(const fs::path& file) { return file.filename() == "main.cpp"; }

TEST(Names, MeanOneThingInEachNamespace) {
  std::map<std::string, std::string> defined_in;
  std::size_t count = 0;
  for (const char* folder : {"solution", "meshing", "radiosity", "proto", "import", "server", "client"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(ALVOR_SOURCE) / folder)) {
      const auto extension = entry.path().extension();
      const bool is_ours = entry.path().string().find("node_modules") == std::string::npos;
      if (!is_ours || is_program(entry.path()) || (extension != ".h" && extension != ".cpp")) continue;
      const std::string file = fs::relative(entry.path(), ALVOR_SOURCE).string();
      for (const std::string& name : definitions(entry.path())) {
        const auto [first, is_new] = defined_in.emplace(name, file);
        EXPECT_TRUE(is_new) << name << " is defined in " << first->second << " and in " << file;
        ++count;
      }
    }
  EXPECT_GT(count, 500u);
}

}  // namespace
