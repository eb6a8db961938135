#pragma once

#include "bench/obj_writer.h"

namespace alvor::bench {

/// The main function of a program that writes one scene, NAME.obj and NAME.mtl, into the folder that is its only argument;
/// returns its exit status.
int run_scene_program(int count, char** arguments, const std::string& name, std::span<const Paint> paints, ObjWriter (*scene)());

}  // namespace alvor::bench
