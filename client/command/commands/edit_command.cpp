// alvor edit SOLVE: changes the scene of a solve on a server.

#include "client/command/commands/commands.h"
#include "client/command/commands/connection.h"
#include "client/command/commands/follow.h"
#include "client/command/commands/interrupt.h"
#include "client/command/commands/submitted_scene.h"
#include "client/command/options/edit_option.h"
#include "client/command/options/light_options.h"
#include "client/command/options/sky_options.h"
#include "client/command/options/solve_name.h"
#include "client/command/options/up_option.h"
#include "client/command/output/failure.h"
#include "client/command/output/notes.h"
#include "client/command/output/numbers.h"
#include "proto/codec.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace alvor {

namespace {

struct EditCommand {
  std::string solve;
  ServerChoice server;
  std::vector<std::string> settings, dims, webs, copies, additions, moves, turns, scales, hidden, shown;
  LightOptions added_light;  ///< of the files of `additions`
  std::string added_up;      ///< "y" or "z"; empty: as these files say
  bool says_how_files_are_read = false;
  std::string absorption;
  SkyOptions sky;
  bool no_daylight = false;
  std::string script, author;
  bool undo = false, redo = false, wait = false;
  std::optional<std::uint64_t> base_revision;
};

v1::EditStep step_of(const EditCommand& command) {
  v1::EditStep step;
  if (!command.script.empty()) step = step_of_script(command.script);
  for (const std::string& setting : command.settings) *step.add_edits() = edit_of_setting(setting);
  for (const std::string& dim : command.dims) *step.add_edits() = edit_of_dim(dim);
  for (const std::string& web : command.webs) *step.add_edits() = edit_of_web(web);
  if (!command.absorption.empty()) *step.add_edits() = edit_of_absorption(command.absorption);
  for (const std::string& addition : command.additions) *step.add_edits() = edit_of_addition(addition);
  for (const std::string& copy : command.copies) *step.add_edits() = edit_of_copy(copy);
  for (const std::string& move : command.moves) *step.add_edits() = edit_of_move(move);
  for (const std::string& turn : command.turns) *step.add_edits() = edit_of_turn(turn);
  for (const std::string& scale : command.scales) *step.add_edits() = edit_of_scale(scale);
  for (const std::string& name : command.hidden) *step.add_edits() = edit_of_hidden(name, true);
  for (const std::string& name : command.shown) *step.add_edits() = edit_of_hidden(name, false);
  const auto daylight = daylight_of(command.sky);
  if (daylight && command.no_daylight) throw Failure(ExitStatus::usage, "--no-daylight: a sun or a sky is given, too");
  if (daylight) *step.add_edits()->mutable_daylight() = *daylight;
  if (command.no_daylight) step.add_edits()->mutable_daylight();
  if (command.undo || command.redo) step.set_kind(command.undo ? v1::EditStep::UNDO : v1::EditStep::REDO);
  const bool is_edit = step.kind() != v1::EditStep::UNDO && step.kind() != v1::EditStep::REDO;
  if (is_edit == (step.edits_size() == 0))
    throw Failure(
        ExitStatus::usage,
        is_edit
            ? "nothing to edit: give --set, --dim, --web, --absorption, --copy, --add, --move, --turn, --scale, --hide, --show, "
              "--sun, --time, --sky, --no-daylight, --script, --undo or --redo"
            : "--undo and --redo stand alone");
  step.set_author(command.author);
  return step;
}

/// The scene files of a step's additions, submitted. Deletes these scenes again, unless keep() is called.
class SubmittedAdditions {
 public:
  /// `import`: how all files are read.
  SubmittedAdditions(Client& client, SceneImport import) : client_(client), import_(std::move(import)) {}
  ~SubmittedAdditions() {
    for (const std::string& scene : scenes_) {
      try {
        client_.delete_scene(scene);
      } catch (const RpcError&) {  // it is used meanwhile, or the connection is lost
      }
    }
  }
  SubmittedAdditions(const SubmittedAdditions&) = delete;
  /// Puts names of scenes in the place of those of files. Throws RpcError, SceneFileError.
  void submit_all(v1::EditStep& step) {
    for (v1::Edit& edit : *step.mutable_edits())
      if (const std::string& scene = edit.copy().scene(); !scene.empty() && !is_of_server(scene))
        edit.mutable_copy()->set_scene(submitted(scene));
  }
  bool is_any() const { return !scenes_.empty(); }
  void keep() { scenes_.clear(); }

 private:
  static bool is_of_server(const std::string& scene) {
    std::error_code ignored;
    return scene.starts_with("scenes/") && !std::filesystem::is_regular_file(scene, ignored);
  }
  std::string submitted(const std::filesystem::path& file) {
    RawScene bytes = scene_bytes(file, "");
    SceneImport import = import_;
    import.options.MergeFrom(import_options(bytes.file, file));
    const v1::Scene scene = submit(client_, std::move(bytes), import, file);
    scenes_.push_back(scene.name());
    std::vector<std::string> warnings(scene.warnings().begin(), scene.warnings().end());
    std::erase_if(warnings, [](const std::string& warning) { return warning.ends_with("the solution will be dark."); });
    warn(warnings);
    return scene.name();
  }

  Client& client_;
  const SceneImport import_;
  std::vector<std::string> scenes_;
};

SceneImport import_of_additions(const EditCommand& command) {
  SceneImport import;
  take_light_options(command.added_light, import);
  if (is_axis(command.added_up)) import.options.set_up_axis(encode(command.added_up == "z" ? UpAxis::z : UpAxis::y));
  return import;
}

void run_edit(const EditCommand& command) {
  scene_name_of(command.solve);
  v1::EditStep step = step_of(command);
  Interrupt interrupt;
  Connection connection(command.server);
  Client& client = connection.client();
  SubmittedAdditions additions(client, import_of_additions(command));
  additions.submit_all(step);
  if (!additions.is_any() && command.says_how_files_are_read)
    throw Failure(ExitStatus::usage, "--light-scale, --quantity and --up are for files: the server has read its scenes already");
  const v1::EditSolveResponse edited = client.edit_solve(command.solve, step, command.base_revision);
  additions.keep();
  notes() << "edits of revision " << edited.revision() << '\n';
  if (edited.state() == v1::Solve::PAUSED) notes() << "the solve is paused: it heeds them when it is resumed\n";
  if (!command.wait || edited.state() == v1::Solve::PAUSED) return;
  const FollowOptions options{std::chrono::steady_clock::now(), false};
  const Followed followed = follow(client, client.get_solve(command.solve), options, interrupt.token());
  if (followed.solve.state() == v1::Solve::FAILED)
    throw Failure(ExitStatus::failed, "the solve failed: " + followed.solve.end_reason());
  if (followed.solve.state() == v1::Solve::CANCELLED) throw Failure(ExitStatus::failed, "the solve was cancelled");
  const Step last = followed.mirror.steps().empty() ? Step{} : followed.mirror.steps().back();
  notes() << "estimated error " << percent(last.estimated_error) << ", " << compact(static_cast<double>(last.rays))
          << " rays: " << (followed.solve.end_reason().empty() ? "still running" : followed.solve.end_reason()) << '\n';
}

}  // namespace

void add_edit_command(CLI::App& app) {
  const auto options = std::make_shared<EditCommand>();
  CLI::App& command = *app.add_subcommand(
      "edit", "Change materials, lights, objects and daylight of a solve on a server, while it runs or afterwards");
  command.add_option("solve", options->solve, "Name of the solve: scenes/SCENE/solves/SOLVE")->required()->type_name("SOLVE");
  add_server_option(command, options->server, "Server that holds the solve").required();
  const auto add_repeatable = [&](const char* name, std::vector<std::string>& values, const char* type, const char* help) {
    command.add_option(name, values, help)->type_name(type)->allow_extra_args(false);
  };
  add_repeatable("--set", options->settings, "SETTING",
                 "material:NAME.FIELD=R,G,B with emission, reflectance, diffuse_transmittance or regular_transmittance, or "
                 "light:NAME.FIELD=X,Y,Z with "
                 "intensity, position or direction, or light:NAME.cone=INNER,OUTER in degrees");
  add_repeatable("--dim", options->dims, "DIM",
                 "light:NAME=FACTOR or object:NAME=FACTOR: multiply what a light, or the faces of an object, send out; 0 is off");
  add_repeatable("--web", options->webs, "WEB",
                 "NAME=FILE: a photometric file (IES, EULUMDAT) in place of the one that a luminaire has");
  command.add_option("--absorption", options->absorption, "Absorption coefficient of the medium, 1/m per band")
      ->type_name("R,G,B");
  add_repeatable("--copy", options->copies, "COPY",
                 "NEW=NAME: add an object, a copy of another one as the scene was submitted with it");
  add_repeatable("--add", options->additions, "ADDITION",
                 "NEW=FILE: add an object, all faces and lamps of a scene file, where the file has them; the file is submitted "
                 "as a scene of "
                 "its own, which stays. Or NEW=scenes/SCENE: a scene of the server");
  add_file_light_options(command, options->added_light);
  add_up_option(command, options->added_up);
  command.get_option("--light-scale")
      ->description("Multiply the intensity of the lamps in the files of --add, not of emissive faces (1)");
  command.get_option("--quantity")->description("Unit of the light of these files: radiometric (W) or photometric (lm)");
  command.get_option("--up")->description("Axis that points up in the files of --add, if not as for alvor solve");
  for (const char* name : {"--light-scale", "--quantity", "--up"}) command.get_option(name)->needs("--add");
  add_repeatable("--move", options->moves, "MOVE",
                 "NAME=X,Y,Z: put an object so many metres from where the scene as submitted has it");
  add_repeatable("--turn", options->turns, "TURN",
                 "NAME=DEGREES: turn an object about the vertical through its middle, counter-clockwise seen from above; "
                 "NAME=DEGREES,X,Y,Z: about an axis of this direction, seen from where it points to");
  add_repeatable("--scale", options->scales, "SCALE",
                 "NAME=FACTOR: make an object so many times as large as the scene as submitted has it, about its middle");
  add_repeatable("--hide", options->hidden, "NAME", "Take an object away");
  add_repeatable("--show", options->shown, "NAME", "Bring an object back");
  add_sky_options(command, options->sky);
  command.get_option("--north")->description("Degrees, clockwise seen from above, from the scene's north to that of --sun (0)");
  command.add_flag("--no-daylight", options->no_daylight, "Let no sun, sky or surroundings shine");
  command.add_option("--script", options->script, "A step of edits as JSON, with the fields of EditStep")
      ->type_name("EDITS.json");
  command.add_flag("--undo", options->undo, "Take back the newest step that holds");
  command.add_flag("--redo", options->redo, "Make the step that was taken back last hold again")->excludes("--undo");
  command.add_option("--author", options->author, "Who makes the edits, for people")->type_name("NAME");
  command.add_option("--base-revision", options->base_revision, "Refuse if there are newer edits than this revision")
      ->type_name("N");
  command.add_flag("--wait", options->wait, "Follow the solve until it has ended");
  command.callback([options, &command] {
    for (const char* name : {"--light-scale", "--quantity", "--up"})
      options->says_how_files_are_read |= command.get_option(name)->count() > 0;
    run_edit(*options);
  });
}

}  // namespace alvor
