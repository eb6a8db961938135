#pragma once
// The option of commands that take a solve on a server in place of a scene file.

#include "client/command/options/server_option.h"

#include <CLI/CLI.hpp>

#include <initializer_list>
#include <string>

namespace alvor {

/// Help text of the argument `scene` of commands that take a scene file or a solve on a server.
inline constexpr const char* scene_or_solve =
    "OBJ, glTF, GLB or another scene file, or scenes/SCENE/solves/SOLVE on a server; - is stdin";

/// Adds --server and what belongs to it. With it none of the options can be given that say how a scene or solution file is read,
/// nor `others`, of those that the command has already.
void add_served_solve_option(CLI::App& command, ServerChoice& server, std::initializer_list<const char*> others = {});

/// Throws Failure (usage) if a file that is to be read is not there and has the name of a solve, but no server was chosen.
void require_server(const ServerChoice& server, const std::string& file);

}  // namespace alvor
