#include "client/command/options/usage_message.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace alvor {

namespace {

/// Returns how many letters must be changed, added, removed or swapped with the next to turn `a` into `b` (optimal string
/// alignment).
std::size_t edits_between(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> edits(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) edits[i][0] = i;
  std::iota(edits[0].begin(), edits[0].end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = edits[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
      edits[i][j] = std::min({edits[i - 1][j] + 1, edits[i][j - 1] + 1, change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        edits[i][j] = std::min(edits[i][j], edits[i - 2][j - 2] + 1);
    }
  return edits[a.size()][b.size()];
}

/// Returns the command that got words it does not know, or else the last one chosen: for `alvor solves list`, the list.
const CLI::App& command_at_fault(const CLI::App& app) {
  const auto subcommands = app.get_subcommands();
  return subcommands.empty() || !app.remaining().empty() ? app : command_at_fault(*subcommands.front());
}

/// Returns the command's name with those of its parents, such as "alvor solves list".
std::string full_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return (parent ? full_name(*parent) + " " : "") + command.get_name();
}

std::vector<std::string> subcommands_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* subcommand : command.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(subcommand->get_name());
  return names;
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

bool is_option(const std::string& word) { return word.size() > 1 && word.starts_with('-') && word != "--"; }

/// Returns the fault, with a suggestion unless `meant` is empty.
std::string with_suggestion(const std::string& fault, const std::string& meant) {
  return meant.empty() ? fault : fault + "; did you mean " + meant + "?";
}

std::string unknown_option(const CLI::App& command, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  return with_suggestion("there is no option " + name, nearest_word(name, options_of(command)));
}

std::string unknown_command(const std::string& word, std::span<const std::string> commands) {
  const std::string nearest = nearest_word(word, commands);
  return with_suggestion("there is no command '" + word + "'", nearest.empty() ? "" : "'" + nearest + "'");
}

/// Returns the fault to report. Unknown words are reported before their consequences, such as a missing required argument.
std::string fault_of(const CLI::App& command, const CLI::Error& error) {
  const std::vector<std::string> unknown = command.remaining(), commands = subcommands_of(command);
  if (!commands.empty() && !unknown.empty() && !is_option(unknown.front())) return unknown_command(unknown.front(), commands);
  const auto option = std::ranges::find_if(unknown, is_option);
  if (option != unknown.end()) return unknown_option(command, *option);
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError) && !unknown.empty())
    return "'" + unknown.front() + "' is one argument too many";
  return error.what();
}

}  // namespace

std::string nearest_word(const std::string& typed, std::span<const std::string> words) {
  std::string nearest;
  std::size_t fewest = std::max<std::size_t>(2, typed.size() / 3 + 1);  // with this many edits it is a different word
  for (const std::string& word : words) {
    const bool is_begun = typed.size() >= 3 && word.starts_with(typed);
    const std::size_t edits = is_begun ? 1 : edits_between(typed, word);
    if (edits >= fewest) continue;
    fewest = edits;
    nearest = word;
  }
  return nearest;
}

std::string usage_message(const CLI::App* app, const CLI::Error& error) {
  const CLI::App& command = command_at_fault(*app);
  const std::string name = full_name(command);
  std::string line = name + ": " + fault_of(command, error);
  if (!line.ends_with('?')) line += " (see " + name + " --help)";
  std::ranges::replace(line, '\n', ' ');
  return line + '\n';
}

}  // namespace alvor
