#pragma once
// The sections of the page that consist mostly of tables.

#include "bench/error_vs_time/page/page.h"

namespace alvor::bench {

std::string targets_section(const Measurements& measured);
std::string truth_section(const Measurements& measured);
std::string scene_section(const SceneContest& held, double yardstick_s);
std::string parts_section(const Measurements& measured);
std::string estimate_section(const Measurements& measured);
std::string path_tracing_section(const Measurements& measured);
std::string fixed_mesh_section(const Measurements& measured);

}  // namespace alvor::bench
