#pragma once
// Edits of a solve's scene on the command line.

#include "alvor/v1/solve_service.pb.h"

#include <string>

namespace alvor {

/// Returns the edit of `--set PART:NAME.FIELD=VALUE`. Throws Failure (usage) that names the option.
v1::Edit edit_of_setting(const std::string& setting);
/// Returns the edit of `--dim PART:NAME=FACTOR`. Throws Failure (usage) that names the option.
v1::Edit edit_of_dim(const std::string& dim);
/// Returns the edit of `--web NAME=FILE`, a photometric file. Throws Failure (usage, or no input) that names the option or the
/// file.
v1::Edit edit_of_web(const std::string& web);
/// Returns the edit of `--absorption R,G,B`. Throws Failure (usage) that names the option.
v1::Edit edit_of_absorption(const std::string& absorption);
/// Returns the edits of `--copy NEW=NAME`, `--move NAME=X,Y,Z`, `--turn NAME=DEGREES[,X,Y,Z]`, `--scale NAME=FACTOR`, `--hide
/// NAME` and `--show NAME`, of objects. Throw Failure (usage) that names the option.
v1::Edit edit_of_copy(const std::string& copy);
/// Returns the edit of `--add NEW=FILE` or `--add NEW=scenes/SCENE`. The file, or the scene, is in `copy.scene`. Throws Failure
/// (usage) that names the option.
v1::Edit edit_of_addition(const std::string& addition);
v1::Edit edit_of_move(const std::string& move);
v1::Edit edit_of_turn(const std::string& turn);
v1::Edit edit_of_scale(const std::string& scale);
v1::Edit edit_of_hidden(const std::string& name, bool hidden);
/// Returns the step of a JSON file: {"edits": [{"material": {"name": "wall", "reflectance": {"r": 0.2, "g": 0.2, "b": 0.2}}}]},
/// with the fields of EditStep. Throws Failure (usage) that names the file.
v1::EditStep step_of_script(const std::string& path);

}  // namespace alvor
