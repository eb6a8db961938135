#include "client/command/options/scene_options.h"

#include "client/command/options/absorption_option.h"
#include "client/command/options/translucent_option.h"
#include "client/command/options/up_option.h"
#include "client/command/output/notes.h"
#include "import/base/scene_format.h"
#include "proto/codec.h"

#include <utility>

namespace alvor {

void add_scene_options(CLI::App& command, SceneOptions& options) {
  add_absorption_option(command, options.absorption);
  add_light_options(command, options.light);
  add_translucent_option(command, options.translucent);
  add_up_option(command, options.up);
}

Scene read_scene(const SceneOptions& options, const RawScene& bytes, const std::string& name) {
  SceneImport import;
  take_light_options(options.light, import);
  take_translucent(options.translucent, import.options);
  if (is_axis(options.up)) import.options.set_up_axis(encode(options.up == "z" ? UpAxis::z : UpAxis::y));
  SceneFile file = read_scene_content({name, bytes.bytes, lower_case_extension(bytes.file), bytes.folder}, import);
  take_absorption(options.absorption, file.scene);
  warn(file.warnings);
  return std::move(file.scene);
}

}  // namespace alvor
