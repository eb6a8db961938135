// Checks in which library the linker finds each third-party symbol of `alvor` and `alvor-import`. Two libraries may export the
// same names: libdraco, which Assimp loads, exports functions of its own version of tinygltf, and our calls once reached those.

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace alvor {
namespace {

namespace fs = std::filesystem;

struct Binding {
  std::string from, to, symbol;
};

std::string file_name(const std::string& path) { return fs::path(path).filename().string(); }

/// Returns all symbols as the dynamic linker binds them (LD_DEBUG, ld.so(8)): "binding file A [0] to B [0]: normal symbol `f'
/// [V]".
std::vector<Binding> bindings_of(const std::string& command) {
  const fs::path log = fs::temp_directory_path() / ("alvor_bindings_" + std::to_string(getpid()));
  const std::string whole = "LD_BIND_NOW=1 LD_DEBUG=bindings LD_DEBUG_OUTPUT='" + log.string() + "' " + command + " > /dev/null";
  EXPECT_EQ(std::system(whole.c_str()), 0);
  std::vector<Binding> bindings;
  for (const auto& entry : fs::directory_iterator(log.parent_path())) {
    if (!entry.path().filename().string().starts_with(log.filename().string())) continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      const auto start = line.find("binding file "), to = line.find(" to "), quote = line.find('`'), end = line.find('\'', quote);
      if (start == std::string::npos || to == std::string::npos || end == std::string::npos) continue;
      const auto word_at = [&](std::size_t at) { return line.substr(at, line.find(' ', at) - at); };
      bindings.push_back({file_name(word_at(start + 13)), file_name(word_at(to + 4)), line.substr(quote + 1, end - quote - 1)});
    }
    fs::remove(entry.path());
  }
  return bindings;
}

bool has(const std::string& symbol, std::string_view part) { return symbol.find(part) != std::string::npos; }

/// The programs, with arguments after which they end at once.
const std::array programs{std::pair{"alvor", "--version"}, std::pair{"alvor-import", "100000000000 1 < /dev/null"}};

const std::vector<Binding>& all_bindings() {
  static const std::vector<Binding> all = [] {
    std::vector<Binding> both;
    for (const auto& [program, arguments] : programs)
      for (Binding& binding : bindings_of(std::string(ALVOR_BINARIES "/") + program + " " + arguments))
        both.push_back(std::move(binding));
    return both;
  }();
  return all;
}

bool is_ours(const std::string& file) { return file == "alvor" || file == "alvor-import"; }

TEST(Symbols, OfLibrariesInHeadersStayInTheirProgram) {
  ASSERT_GT(all_bindings().size(), 1000u);
  for (const Binding& binding : all_bindings()) {
    if (!is_ours(binding.from) && !is_ours(binding.to)) continue;
    if (binding.from == binding.to) continue;
    for (const char* name : {"tinygltf", "tinyobj", "nlohmann", "stbi_"})
      EXPECT_FALSE(has(binding.symbol, name)) << binding.symbol << " of " << binding.from << " is found in " << binding.to;
  }
}

TEST(Symbols, OfSharedLibrariesAreFoundInTheseAndNoOthers) {
  struct Library {
    const char* prefix;  ///< prefix of the mangled name
    const char* file;
  };
  constexpr std::array libraries{Library{"_ZN6Assimp", "libassimp.so"},
                                 Library{"_ZNK6Assimp", "libassimp.so"},
                                 Library{"ai", "libassimp.so"},
                                 Library{"rtc", "libembree3.so"},
                                 Library{"_ZN8OpenMesh", "libOpenMeshCore.so"},
                                 Library{"png_", "libpng16.so"},
                                 Library{"ZSTD_", "libzstd.so"},
                                 Library{"WebP", "libwebp.so"},
                                 Library{"sqlite3_", "libsqlite3.so"},
                                 Library{"_ZN6google8protobuf", "libprotobuf.so"},
                                 Library{"_ZN3tbb6detail", "libtbb.so"}};
  std::size_t checked = 0;
  for (const Binding& binding : all_bindings()) {
    if (!is_ours(binding.from) || is_ours(binding.to)) continue;
    for (const auto& [prefix, file] : libraries) {
      if (!binding.symbol.starts_with(prefix)) continue;
      ++checked;
      EXPECT_TRUE(binding.to.starts_with(file)) << binding.symbol << " is found in " << binding.to;
    }
  }
  EXPECT_GT(checked, 100u);
}

}  // namespace
}  // namespace alvor
