// alvor bake SCENE -o BAKED.glb: solves a scene and writes it with its light in textures.

#include "client/bake/bake.h"
#include "client/bake/probe_grid.h"
#include "client/bake/scene_document.h"
#include "client/command/commands/commands.h"
#include "client/command/commands/served_solution.h"
#include "client/command/commands/solve_here.h"
#include "client/command/options/input_file.h"
#include "client/command/options/option_checks.h"
#include "client/command/options/scene_options.h"
#include "client/command/options/served_solve_option.h"
#include "client/command/output/display.h"
#include "client/command/output/failure.h"
#include "client/command/output/files.h"
#include "client/command/output/notes.h"
#include "client/command/output/numbers.h"
#include "client/command/output/output_file.h"
#include "client/command/output/status_line.h"
#include "client/verify/verification.h"
#include "import/base/scene_format.h"
#include "import/base/whole_file.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

namespace alvor {

namespace {

using nlohmann::json;

constexpr std::string_view glb_formats[]{"glb"};
const FileKind baked_kind{"a baked scene", glb_formats, false, false};

const std::map<std::string, BakeForm> forms{
    {"lightmap", BakeForm::lightmap}, {"unlit", BakeForm::unlit}, {"vertex", BakeForm::vertex}};
const std::map<std::string, LightmapFormat> formats{{"png", LightmapFormat::png}, {"exr", LightmapFormat::exr}};
const std::map<std::string, LightmapUnit> conventions{{"three", LightmapUnit::irradiance},
                                                      {"godot", LightmapUnit::irradiance_over_pi},
                                                      {"unity", LightmapUnit::irradiance_over_pi}};
const std::map<std::string, BakedSide> sides{{"inner", BakedSide::inner}, {"brighter", BakedSide::brighter}};

struct BakeCommand {
  std::filesystem::path scene, solution;  ///< an empty solution: the scene is solved
  ServerChoice server;                    ///< given: `scene` is the name of a solve
  std::string format;                     ///< format of a scene from stdin
  OutputFile output;
  std::string form = "lightmap", lightmap_format = "png", convention = "three", side = "inner";
  BakeOptions bake;
  std::string probes;  ///< NX,NY,NZ; empty: none
  SolveOptions solve;
  SceneOptions scene_options;
};

/// A scene, the document that is to show it, and its solution; no solution if the scene is still to be solved.
struct SceneToBake {
  Scene scene;
  GltfDocument document;
  std::optional<DisplayMesh> solution;
};

GltfDocument document_of(const RawScene& bytes, const Scene& scene) {
  const std::string extension = lower_case_extension(bytes.file);
  if (extension != ".glb" && extension != ".gltf") return document_of(scene);
  return GltfDocument(bytes.bytes, [&](const std::string& name) { return read_beside(bytes.folder, name); });
}

BakeOptions options_of(const BakeCommand& command) {
  BakeOptions options = command.bake;
  options.form = forms.at(command.form);
  options.format = formats.at(command.lightmap_format);
  options.unit = conventions.at(command.convention);
  options.side = sides.at(command.side);
  options.name = command.output.path.stem().string();
  return options;
}

/// Returns what `work` returns. Turns a BakeError into a Failure that names the scene.
template <class Work>
auto naming_the_scene(const BakeCommand& command, Work work) {
  try {
    return work();
  } catch (const BakeError& error) {
    throw Failure(ExitStatus::bad_scene, name_of(command.scene) + ": " + error.what());
  }
}

/// Bakes and shows how far it is.
Baked baked(BakeOptions options, GltfDocument document, const Scene& scene, const DisplayMesh& solution,
            std::shared_ptr<const ChartLayout> layout) {
  StatusLine line;
  std::mutex mutex;
  options.on_progress = [&](double share) {
    const std::unique_lock lock(mutex, std::try_to_lock);
    if (lock && line.on_terminal() && (line.due() || share == 1))
      line.show(progress_bar(share) + " " + percent(share) + " of the texels");
  };
  return bake(std::move(document), scene, solution, options, std::move(layout));
}

SceneToBake scene_to_bake(const BakeCommand& command) {
  if (command.server.is_given()) {
    ServedSolve solve = read_served_solve(command.server, command.scene);
    GltfDocument document = naming_the_scene(command, [&] { return document_of(solve.scene); });
    return {std::move(solve.scene), std::move(document), std::move(solve.mesh)};
  }
  const RawScene bytes = scene_bytes(command.scene, command.format);
  Scene scene = read_scene(command.scene_options, bytes, name_of(command.scene));
  GltfDocument document = naming_the_scene(command, [&] { return document_of(bytes, scene); });
  return {std::move(scene), std::move(document), std::nullopt};
}

/// Returns the solution of the scene, given or solved. Throws Failure if the given one is of another scene.
DisplayMesh solution_for(const BakeCommand& command, const Scene& scene) {
  if (command.solution.empty()) return solve_here(scene, command.solve, name_of(command.scene)).mesh;
  DisplayMesh solution = read_solution(command.solution, {});
  try {
    require_same_box(scene, solution);
  } catch (const MismatchError& error) {
    throw Failure(ExitStatus::bad_scene, name_of(command.solution) + ": " + error.what());
  }
  return solution;
}

void require_other_output(const BakeCommand& command) {
  std::error_code is_none;
  for (const auto& input : {command.scene, command.solution})
    if (!is_stream(input) && std::filesystem::equivalent(input, command.output.path, is_none))
      throw Failure(ExitStatus::usage, "--output: " + name_of(input) + " is read: write another file");
}

/// Returns the numbers of "NX,NY,NZ". Throws Failure (usage).
ProbeCounts counts_of(const std::string& text) {
  ProbeCounts counts{};
  char rest = 0;
  const int read = std::sscanf(text.c_str(), "%d,%d,%d%c", &counts[0], &counts[1], &counts[2], &rest);
  const bool are_positive = std::ranges::all_of(counts, [](int count) { return count > 0 && count <= most_probes; });
  if (read != 3 || !are_positive || double(counts[0]) * counts[1] * counts[2] > most_probes)
    throw Failure(ExitStatus::usage, "--probes: '" + text + "' is not NX,NY,NZ, three whole numbers of together at most " +
                                         std::to_string(most_probes) + " probes");
  return counts;
}

/// Gathers the probes and returns them as JSON.
json gathered_probes(const ProbeCounts& counts, const Scene& scene, const DisplayMesh& solution) {
  const auto probes = turned_upright(probe_grid(solution, counts, scene.absorption), scene.up);
  const auto enclosed = std::ranges::count(probes, true, &AirProbe::is_enclosed);
  if (enclosed > 0) notes() << enclosed << " of " << probes.size() << " probes are inside solids or outside the room\n";
  return probes_json(probes, counts, solution.quantity);
}

/// Writes the files beside the GLB first, so that a GLB that is there has what it names.
void write(const BakeCommand& command, const Baked& baked) {
  for (const Baked::File& file : baked.beside) {
    const auto path = command.output.path.parent_path() / file.name;
    write_whole_file(path, file.bytes);
    notes() << "wrote " << path.string() << '\n';
  }
  write_output(command.output.path, baked.glb);
  if (!is_stream(command.output.path)) notes() << "wrote " << command.output.path.string() << '\n';
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + ' ' + (count == 1 ? one : many);
}

std::string summary_of(const BakeCommand& command, const Baked& baked) {
  if (baked.pages == 0) return counted(baked.nodes, "mesh", "meshes") + " with colours at their vertices\n";
  std::string text = counted(baked.nodes, "mesh", "meshes") + " in " + counted(baked.charts, "chart", "charts") + " on " +
                     counted(static_cast<std::size_t>(baked.pages), "texture", "textures") + " of " +
                     std::to_string(command.bake.size) + " x " + std::to_string(command.bake.size) + ", " +
                     compact(baked.texels_per_metre) + " texels per metre";
  if (baked.range > 0)
    text += "; brightest value " + compact(baked.range) + ", " + percent(baked.clipped_share) + " of the texels are brighter";
  if (baked.told_error) text += "; told error of the texels " + percent(*baked.told_error) + " of their mean (RMS)";
  return text + '\n';
}

void run_bake(const BakeCommand& command) {
  require_server(command.server, command.scene);
  if (!command.server.is_given()) require_inputs({{InputKind::scene, command.scene}}, command.format);
  require_output(command.output, baked_kind, "--output");
  if (is_stream(command.output.path) && command.lightmap_format == "exr")
    throw Failure(ExitStatus::usage, "--output: lightmaps in EXR are files beside the scene, so it cannot go to stdout");
  std::optional<ProbeCounts> counts;
  if (!command.probes.empty()) counts = counts_of(command.probes);
  if (command.bake.longest_edge && command.form != "vertex")
    throw Failure(ExitStatus::usage, "--subdivide: only --as vertex has colours at vertices");
  if (command.lightmap_format == "exr" && command.form != "lightmap")
    throw Failure(ExitStatus::usage, "--lightmap-format: only --as lightmap has lightmaps");
  if (command.bake.with_errors && command.form != "lightmap")
    throw Failure(ExitStatus::usage, "--errors: only --as lightmap has lightmaps");
  if (command.bake.with_errors && is_stream(command.output.path))
    throw Failure(ExitStatus::usage, "--output: errors are files beside the scene, so it cannot go to stdout");
  if (is_stream(command.output.path) && counts)
    throw Failure(ExitStatus::usage, "--output: probes are a file beside the scene, so it cannot go to stdout");
  require_other_output(command);
  reserve_stdout_for({command.output.path});
  SceneToBake input = scene_to_bake(command);
  BakeOptions options = options_of(command);
  const auto layout = naming_the_scene(command, [&] { return lay_out(input.document, input.scene, options); });
  const DisplayMesh solution = input.solution ? *std::move(input.solution) : solution_for(command, input.scene);
  if (command.bake.with_errors)
    require_told_errors(solution, name_of(command.solution.empty() ? command.scene : command.solution));
  if (counts) options.extras["alvor_probes"] = gathered_probes(*counts, input.scene, solution);
  Baked result =
      naming_the_scene(command, [&] { return baked(options, std::move(input.document), input.scene, solution, layout); });
  if (counts)
    result.beside.push_back({command.output.path.stem().string() + "-probes.json", options.extras["alvor_probes"].dump()});
  if (result.lit_from_both > 0)
    warn(std::array{std::to_string(result.lit_from_both) + " of " + std::to_string(result.charts) +
                    (result.pages > 0 ? " charts" : " primitives") +
                    " with two sides have light on the one that is not shown (see --side)"});
  write(command, result);
  notes() << summary_of(command, result);
}

void add_solve_options(CLI::App& command, BakeCommand& options) {
  command
      .add_option("--solution", options.solution, "Bake this solution of the scene (.glb of alvor solve) instead of solving it")
      ->type_name("SOLUTION");
  add_solve_limits(command, options.solve);
  add_scene_options(command, options.scene_options);
}

void add_texture_options(CLI::App& command, BakeCommand& options) {
  command
      .add_option("--as", options.form,
                  "lightmap: irradiance in textures of their own, on texture coordinates of their own; unlit: the colours of a "
                  "picture of the solution, for every viewer; vertex: such colours at the vertices, without textures (lightmap)")
      ->check(CLI::IsMember(forms));
  command
      .add_option(
          "--lightmap-format", options.lightmap_format,
          "png: in the GLB, 8 bits sRGB up to a range that MOZ_lightmap tells as its intensity; exr: half floats in files "
          "beside the GLB (png)")
      ->check(CLI::IsMember(formats));
  command
      .add_option(
          "--convention", options.convention,
          "What a texel holds. three: irradiance E, as lightMap of three.js; godot, unity: E / pi, the radiance of a white "
          "surface, as those engines multiply by the colour (three)")
      ->check(CLI::IsMember(conventions));
  command
      .add_option("--side", options.side,
                  "Which side is shown of surfaces with two sides. inner: that of a wall to its room, from which fewer diffuse "
                  "paths leave the scene, and where both "
                  "do alike the brighter one; brighter (inner)")
      ->check(CLI::IsMember(sides));
  command.add_flag("--keep-lights", options.bake.keeps_lights,
                   "Keep the file's lamps beside the lightmap, for things that move; viewers add their light once more");
  command.add_flag("--errors", options.bake.with_errors,
                   "Also write the told error of each texel of a lightmap, one standard deviation, in BAKED-error-0.exr and so on");
  command.add_option("--size", options.bake.size, "Columns and rows of each texture (1024)")->check(CLI::Range(16, 8192));
  command
      .add_option("--texels-per-metre", options.bake.texels_per_metre,
                  "Texels per metre, on as many textures as it takes, up to 64 (as many as fit one texture)")
      ->check(above_up_to(0, 1e6));
  command
      .add_option("--probes", options.probes,
                  "Light in the air for things that move: NX,NY,NZ probes in a grid over the scene, in BAKED-probes.json and in "
                  "the extras "
                  "of the scene")
      ->type_name("NX,NY,NZ");
  command
      .add_option("--subdivide", options.bake.longest_edge,
                  "With --as vertex: cut triangles until no edge is longer than this, metres (vertices as they are)")
      ->check(above_up_to(0, 1e6))
      ->type_name("METRES");
  command.add_option("--padding", options.bake.padding, "Texels around each chart that repeat its edge (4)")
      ->check(CLI::Range(0, 64));
  command
      .add_option("--range", options.bake.range,
                  "Brightest value of a lightmap in PNG, W/m2 or lx (so that 0.2 % of the texels are brighter)")
      ->check(above_up_to(0, 1e30));
}

}  // namespace

void add_bake_command(CLI::App& app) {
  const auto options = std::make_shared<BakeCommand>();
  CLI::App& command = *app.add_subcommand("bake", "Solve a scene and write it with its light in textures");
  command.add_option("scene", options->scene, scene_or_solve)->required()->type_name("SCENE");
  add_format_option(command, options->format);
  add_output_option(command, options->output, baked_kind, "Scene to write: .glb")
      ->required()
      ->type_name("BAKED.glb");
  add_texture_options(command, *options);
  add_solve_options(command, *options);
  add_served_solve_option(command, options->server, {"--solution", "--keep-lights"});
  for (const char* name : solve_limits) command.get_option("--server")->excludes(command.get_option(name));
  command.callback([options] { run_bake(*options); });
}

}  // namespace alvor
