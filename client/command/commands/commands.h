#pragma once
// The subcommands of `alvor`. Each function adds a subcommand to the command line; parsing runs the one that was chosen.

#include <CLI/CLI.hpp>

namespace alvor {

void add_solve_command(CLI::App& app);
void add_watch_command(CLI::App& app);
void add_edit_command(CLI::App& app);
void add_probe_command(CLI::App& app);
void add_render_command(CLI::App& app);
void add_verify_command(CLI::App& app);
void add_bake_command(CLI::App& app);
void add_report_command(CLI::App& app);
void add_compare_command(CLI::App& app);
void add_explain_command(CLI::App& app);
void add_form_factor_command(CLI::App& app);
void add_form_factors_command(CLI::App& app);
void add_luminaire_command(CLI::App& app);
void add_scenes_command(CLI::App& app);
void add_solves_command(CLI::App& app);

}  // namespace alvor
