// alvor report SCENE|SOLUTION -o DIR: illuminances, glare, daylight factors and luminaires, as a page and as tables.

#include "client/command/commands/commands.h"
#include "client/command/commands/served_solution.h"
#include "client/command/commands/solve_here.h"
#include "client/command/options/absorption_option.h"
#include "client/command/options/input_file.h"
#include "client/command/options/option_checks.h"
#include "client/command/options/scene_options.h"
#include "client/command/options/served_solve_option.h"
#include "client/command/options/solve_name.h"
#include "client/command/options/up_option.h"
#include "client/command/output/display.h"
#include "client/command/output/failure.h"
#include "client/command/output/files.h"
#include "client/command/output/notes.h"
#include "client/command/output/numbers.h"
#include "client/command/output/run_program.h"
#include "client/command/output/status_line.h"
#include "client/export/solution_file.h"
#include "client/picture/units.h"
#include "client/report/report.h"
#include "import/base/scene_format.h"
#include "import/base/whole_file.h"

#include <array>
#include <cctype>
#include <cmath>
#include <ctime>
#include <memory>
#include <optional>
#include <utility>

namespace alvor {

namespace {

constexpr double open_sky = 10'000;         // lx or W/m2 of the overcast sky; daylight factors do not depend on it
constexpr double ground_reflectance = 0.2;  // outside (EN 17037)

struct ReportCommand {
  std::filesystem::path input;  ///< a scene or a solution
  ServerChoice server;          ///< given: `input` is the name of a solve
  std::string format;           ///< format of stdin
  std::filesystem::path folder;
  std::string title;
  ReportOptions report;
  std::vector<std::string> observers;  ///< EYE and TARGET, six numbers each
  bool daylight = false, pdf = false;
  std::size_t verify_points = 300;
  SolveOptions solve;
  SceneOptions scene_options;
  std::string only_for_scenes;  ///< an option that was given and says how a scene is read or solved; empty: none
  std::string only_for_solves;  ///< an option that was given and says how far a scene is solved; empty: none
};

Observer observer_of(const std::string& text, UpAxis axis) {
  const auto numbers = parse_numbers(text, 6);
  if (!numbers)
    throw Failure(ExitStatus::usage, "--observer: '" + text + "' is not EX,EY,EZ,TX,TY,TZ, an eye and a point it looks at");
  const auto& n = *numbers;
  const Vec3 eye{n[0], n[1], n[2]}, way = Vec3{n[3], n[4], n[5]} - eye;
  constexpr double nearly_vertical = 1e-3;
  if (!(length(cross(way, plan_frame(axis, 0).up)) > nearly_vertical * length(way)))
    throw Failure(ExitStatus::usage, "--observer: '" + text + "' looks straight up or down, or nowhere");
  return {eye, normalized(way)};
}

/// Returns the scene under an overcast sky, without other light.
Scene under_overcast_sky(Scene scene) {
  const Vec3 up = plan_frame(scene.up, 0).up;
  for (Material& material : scene.materials) material.emission = {};
  Light sky;
  sky.name = "overcast sky";
  sky.kind = LightKind::sky;
  sky.intensity = {open_sky, open_sky, open_sky};
  sky.direction = -up;
  sky.sky.g = 2;  // CIE: (1 + 2 cos Z) / 3
  Light ground = sky;
  ground.name = "ground";
  ground.intensity = ground_reflectance * sky.intensity;
  ground.direction = up;
  ground.sky = {};
  scene.lights = {sky, ground};
  return scene;
}

/// Returns the rooms of these surfaces. Throws Failure if there are none to report.
std::vector<Room> rooms_in(const ReportCommand& command, const DisplayMesh& mesh) {
  try {
    return find_rooms(mesh, command.report);
  } catch (const ReportError& error) {
    throw Failure(ExitStatus::bad_scene, name_of(command.input) + ": " + error.what());
  }
}

/// Returns the rooms of a scene that is not solved yet; none if no face has an area, which the solve refuses.
std::vector<Room> rooms_in(const ReportCommand& command, const Scene& scene) {
  const BaseMesh mesh(scene);
  return mesh.roots().empty() ? std::vector<Room>{} : rooms_in(command, solution_mesh(mesh, {}));
}

/// A scene or a solution, solved, and its rooms.
struct Solved {
  std::optional<Scene> scene;  ///< not known for a solution file
  std::vector<Room> rooms;
  DisplayMesh mesh;
  std::string unfinished;   ///< why the solve ended before its tolerance; empty if it did not
  std::string scene_title;  ///< of a solve on a server, see ServedSolve
};

Solved solved_on_server(const ReportCommand& command) {
  ServedSolve solve = read_served_solve(command.server, command.input);
  Solved result{std::move(solve.scene), {}, std::move(solve.mesh), std::move(solve.unfinished), std::move(solve.scene_title)};
  result.rooms = rooms_in(command, result.mesh);
  return result;
}

Solved solved(const ReportCommand& command) {
  if (command.server.is_given()) return solved_on_server(command);
  const RawScene bytes = scene_bytes(command.input, command.format);
  const std::string extension = lower_case_extension(bytes.file), name = name_of(command.input);
  if (!is_solution(bytes.bytes, extension)) {
    std::error_code is_none;
    if (!is_stream(command.input) && std::filesystem::equivalent(command.input, command.folder / "solution.glb", is_none))
      throw Failure(ExitStatus::usage, "--output: the report would replace its input " + name);
    Solved result{read_scene(command.scene_options, bytes, name), {}, {}, {}, {}};
    result.rooms = rooms_in(command, *result.scene);  // before the solve, which takes longer than a refusal should
    SolvedHere here = solve_here(*result.scene, command.solve, name);
    result.mesh = std::move(here.mesh), result.unfinished = std::move(here.unfinished);
    return result;
  }
  if (command.daylight) throw Failure(ExitStatus::usage, "--daylight-factor: needs the scene; a solution has its own light only");
  if (!command.only_for_scenes.empty())
    throw Failure(ExitStatus::usage,
                  command.only_for_scenes + ": is for scenes; " + name + " is a solution, which has its light");
  try {
    Solved result{std::nullopt, {}, decode_solution(bytes.bytes, extension, name), {}, {}};
    take_up(command.scene_options.up, result.mesh.up);
    result.rooms = rooms_in(command, result.mesh);
    return result;
  } catch (const SolutionFileError& error) {
    throw Failure(ExitStatus::bad_scene, error.what());
  }
}

Report report_of(const ReportCommand& command, const Solved& solved) {
  ReportOptions options = command.report;
  for (const std::string& text : command.observers) options.observers.push_back(observer_of(text, solved.mesh.up));
  Scene medium;
  take_absorption(command.scene_options.absorption, medium);
  options.absorption = command.server.is_given() ? solved.scene->absorption : medium.absorption;
  std::optional<DisplayMesh> overcast;
  if (command.daylight)
    overcast =
        solve_here(under_overcast_sky(*solved.scene), command.solve, name_of(command.input) + " under an overcast sky").mesh;
  std::optional<DaylightSolution> daylight;
  if (overcast) daylight.emplace(DaylightSolution{*overcast, open_sky});
  StatusLine line;
  line.show("measuring the light in the rooms");
  return make_report(solved.mesh, solved.rooms, options, daylight);
}

std::optional<Verification> verified(const ReportCommand& command, const Solved& solved) {
  if (!solved.scene || command.verify_points == 0) return std::nullopt;
  VerifyOptions options;
  options.points = command.verify_points;
  options.trace.paths = 2000;
  return verify(*solved.scene, solved.mesh, options);
}

std::string plan_name(std::size_t number) { return "plan_" + std::to_string(number) + ".png"; }

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  write_whole_file(path, bytes);
  notes() << "wrote " << path.string() << '\n';
}

void write_pdf(const std::filesystem::path& folder) {
  const std::vector<std::string> arguments{
      "--headless", "--no-sandbox", "--disable-gpu", "--no-pdf-header-footer", "--print-to-pdf=report.pdf", "report.html"};
  for (const char* browser : {"chromium", "chromium-browser", "google-chrome"})
    if (run_program(folder, browser, arguments) && std::filesystem::exists(folder / "report.pdf")) {
      notes() << "wrote " << (folder / "report.pdf").string() << '\n';
      return;
    }
  warn(std::array{std::string("no PDF was written: Chromium was not found or failed. The page prints well from any browser")});
}

/// Removes the files that an earlier report left in the folder and that this one may not write.
void remove_old_files(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::remove(folder / "report.pdf", ignored);
  for (std::size_t n = 1; std::filesystem::remove(folder / plan_name(n), ignored); ++n) {}
}

void write(const ReportCommand& command, const Report& report, const Solved& solved) {
  remove_old_files(command.folder);
  if (solved.scene) {
    write_solution_file(command.folder / "solution.glb", solved.mesh);
    notes() << "wrote " << (command.folder / "solution.glb").string() << '\n';
  }
  write_file(command.folder / "rooms.csv", rooms_csv(report));
  write_file(command.folder / "points.csv", points_csv(report));
  for (std::size_t n = 0; n < report.plans.size(); ++n) write_file(command.folder / plan_name(n + 1), report.plans[n]);
  write_file(command.folder / "report.json", report_json(report));
  write_file(command.folder / "report.html", report_page(report));
  if (command.pdf) write_pdf(command.folder);
}

std::string summary_of(const Report& report) {
  std::string text;
  for (const RoomReport& room : report.rooms) {
    text += room.room.name + ": ";
    if (room.horizontal)
      text += "mean " + shortest(std::round(room.horizontal->mean.value * 10) / 10) + " " + irradiance_unit(report.quantity) +
              ", U0 " + shortest(std::round(room.horizontal->uniformity() * 100) / 100) + ", " +
              std::to_string(room.horizontal->points) + " points\n";
    else text += "no grid point is in the open\n";
  }
  return text;
}

std::string with_capital(std::string sentence) {
  if (!sentence.empty()) sentence[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence[0])));
  return sentence;
}

/// Returns the file or the solve that a report is of, and the file of its scene where that is known.
std::string origin_of(const ReportCommand& command, const Solved& solved) {
  if (is_stream(command.input)) return "a scene from a stream";
  if (!command.server.is_given()) return command.input.filename().string();
  return command.input.string() + (solved.scene_title.empty() ? "" : " (" + solved.scene_title + ")");
}

std::string title_of(const ReportCommand& command, const Solved& solved) {
  if (!command.title.empty()) return command.title;
  if (is_stream(command.input)) return "Lighting of a scene";
  const std::filesystem::path subject = solved.scene_title.empty() ? command.input : std::filesystem::path(solved.scene_title);
  const bool is_file = solved.scene_title.empty() || is_scene_extension(lower_case_extension(subject));
  return "Lighting of " + (is_file ? subject.stem() : subject).string();
}

/// Returns the line that says whence a report comes.
std::string source_of(const std::string& input) {
  const std::time_t now = std::time(nullptr);
  char date[16];
  std::strftime(date, sizeof date, "%Y-%m-%d", std::gmtime(&now));
  return "Made from " + input + " on " + date + " with alvor " ALVOR_VERSION ".";
}

void run_report(const ReportCommand& command) {
  require_server(command.server, command.input);
  if (command.server.is_given()) {
    scene_name_of(command.input);  // before a folder is made
    if (!command.only_for_solves.empty() && !command.daylight)
      throw Failure(ExitStatus::usage, command.only_for_solves + ": with --server nothing is solved, but for --daylight-factor");
  } else {
    require_inputs({{InputKind::scene, command.input}}, command.format);
  }
  make_folder(command.folder, "report.html", "--output");
  const Solved result = solved(command);
  Report report = report_of(command, result);
  warn(report.remarks);
  if (!result.unfinished.empty()) report.remarks.push_back(with_capital(result.unfinished) + ".");
  report.source = source_of(origin_of(command, result));
  report.title = title_of(command, result);
  report.verification = verified(command, result);
  write(command, report, result);
  results() << summary_of(report);
}

void add_plane_options(CLI::App& command, ReportCommand& options) {
  command.add_option("--height", options.report.heights.work, "Height of the work planes above the floor, metres (0.75)")
      ->check(CLI::Range(0.0, 100.0));
  command
      .add_option("--face-height", options.report.heights.face,
                  "Height of eyes: of observers, and of cylindrical and vertical illuminances, metres (1.2)")
      ->check(CLI::Range(0.0, 100.0));
  command
      .add_option("--border", options.report.border,
                  "Width of the strip along walls that is left out, metres; at most 15 % of the room's local width (0.5)")
      ->check(CLI::Range(0.0, 100.0));
  command.add_option("--spacing", options.report.spacing, "Largest distance of grid points, metres (as EN 12464-1 says)")
      ->check(above_up_to(0, 1e6));
  command.add_option("--maintenance-factor", options.report.maintenance_factor, "Multiply illuminances by this factor (1)")
      ->check(above_up_to(0, 1));
  command
      .add_option("--observer", options.observers,
                  "Compute the glare for an eye at E that looks at T: EX,EY,EZ,TX,TY,TZ; any number of times (four in each room)")
      ->type_name("E,T")
      ->allow_extra_args(false);
}

}  // namespace

void add_report_command(CLI::App& app) {
  const auto options = std::make_shared<ReportCommand>();
  CLI::App& command = *app.add_subcommand("report", "Report illuminance, glare and luminaires of the rooms of a scene");
  command
      .add_option("input", options->input,
                  "Scene file, or solution file that alvor solve wrote, or scenes/SCENE/solves/SOLVE on a server; - is stdin")
      ->required()
      ->type_name("SCENE|SOLUTION");
  add_format_option(command, options->format);
  command.add_option("-o,--output", options->folder, "Folder for the page, the tables and the pictures")
      ->required()
      ->type_name("DIR");
  command.add_option("--title", options->title, "Title of the page (Lighting of SCENE)");
  add_plane_options(command, *options);
  command.add_flag("--daylight-factor", options->daylight,
                   "Solve the scene once more, under an overcast sky and without its own light, for daylight factors");
  command
      .add_option("--verify-points", options->verify_points,
                  "Compare the solution with path tracing at this many points of the scene; 0: not at all (300)")
      ->check(CLI::Range(0, 100'000));
  command.add_flag("--pdf", options->pdf, "Print the page to report.pdf, too, by Chromium");
  add_solve_limits(command, options->solve);
  add_scene_options(command, options->scene_options);
  add_served_solve_option(command, options->server);
  command.callback([options, &command] {
    for (const char* name : {"--luminaire", "--light-scale", "--quantity", "--luminous-efficacy", "--sun", "--place", "--sky",
                             "--environment", "--translucent", "--tolerance"})
      if (command.get_option(name)->count() > 0) options->only_for_scenes = name;
    for (const char* name : solve_limits)
      if (command.get_option(name)->count() > 0) options->only_for_solves = name;
    run_report(*options);
  });
}

}  // namespace alvor
