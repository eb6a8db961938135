// alvor form-factors SCENE -o F.csv: writes the form factors between all faces.

#include "client/command/commands/commands.h"
#include "client/command/commands/outputs.h"
#include "client/command/options/input_file.h"
#include "client/command/options/option_checks.h"
#include "client/command/output/failure.h"
#include "client/command/output/files.h"
#include "client/command/output/notes.h"
#include "client/command/output/numbers.h"
#include "client/command/output/output_file.h"
#include "client/command/output/status_line.h"
#include "radiosity/form_factors/form_factor_matrix.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <memory>

namespace alvor {

namespace {

struct FormFactorsCommand {
  std::filesystem::path scene;
  std::string format;  ///< format of a scene from stdin
  OutputFile output;
  std::filesystem::path areas;  ///< empty: not written
  MatrixOptions options;
};

/// Statistics of a matrix, collected row by row.
struct Summary {
  double accuracy = 0;  ///< the accuracy that was asked for
  std::size_t rows = 0, entries = 0, loose = 0, blind = 0;
  double lowest = 1, highest = 0, sum_of_sums = 0, largest_bound = 0;
  std::uint32_t loosest_from = 0, loosest_to = 0;

  void see(std::uint32_t from, std::span<const MatrixEntry> row) {
    double sum = 0;
    for (const MatrixEntry& entry : row) {
      sum += entry.value;
      loose += entry.error_bound > accuracy;
      if (entry.error_bound <= largest_bound) continue;
      largest_bound = entry.error_bound;
      loosest_from = from, loosest_to = entry.to;
    }
    ++rows;
    entries += row.size();
    blind += row.empty();
    lowest = std::min(lowest, sum), highest = std::max(highest, sum), sum_of_sums += sum;
  }

  std::vector<std::string> warnings() const {
    if (entries == 0 && rows > 1) return {"every face looks away from every other: are the normals turned round?"};
    if (loose == 0) return {};
    return {std::to_string(loose) + " of " + std::to_string(entries) +
            " form factors have an error bound above the accuracy of " + shortest(accuracy) + ": the worst is " +
            shortest(largest_bound) + ", from face " + std::to_string(loosest_from) + " to face " + std::to_string(loosest_to)};
  }

  void print(double spent_s) const {
    notes() << rows << " faces, " << entries << " form factors, " << seconds(spent_s) << '\n'
            << "row sums from " << shortest(lowest) << " to " << shortest(highest) << ", mean "
            << shortest(sum_of_sums / static_cast<double>(std::max<std::size_t>(1, rows))) << '\n'
            << "largest error bound " << shortest(largest_bound) << '\n';
    if (blind > 0) notes() << blind << " faces see no other\n";
  }
};

void append_row(std::string& text, std::uint32_t from, double area, std::span<const MatrixEntry> row) {
  for (const MatrixEntry& entry : row)
    text += std::to_string(from) + "," + std::to_string(entry.to) + "," + shortest(entry.value) + "," +
            shortest(entry.error_bound) + "," + shortest(area) + "\n";
}

std::string areas_csv(const FacePolygons& faces) {
  std::string text = "i,area\n";
  for (std::uint32_t face = 0; face < faces.face_count(); ++face)
    text += std::to_string(face) + "," + shortest(faces.area(face)) + "\n";
  return text;
}

/// Writes the rows to a file beside `path` and renames it when complete, because the matrix may be larger than memory; or to
/// stdout.
class RowsFile {
 public:
  explicit RowsFile(const std::filesystem::path& path)
      : path_(path),
        part_(is_stream(path) ? "" : path.string() + ".part"),
        file_(part_),
        out_(part_.empty() ? std::cout : file_) {
    out_ << "i,j,F,error_bound,area_i\n";
  }
  ~RowsFile() {
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
  }
  void write(std::uint32_t from, double area, std::span<const MatrixEntry> row) {
    text_.clear();
    append_row(text_, from, area, row);
    out_ << text_;
    if (part_.empty()) require_stdout_taken();
    if (!out_) throw Failure(ExitStatus::failed, path_.string() + ": could not be written");
  }
  void finish() {
    if (part_.empty()) return;
    file_.close();
    if (!out_) throw Failure(ExitStatus::failed, path_.string() + ": could not be written");
    std::filesystem::rename(part_, path_);
  }

 private:
  std::filesystem::path path_, part_;
  std::ofstream file_;
  std::ostream& out_;
  std::string text_;
};

void show_progress(StatusLine& line, const Summary& summary, const FacePolygons& faces) {
  const double share = static_cast<double>(summary.rows) / static_cast<double>(faces.face_count());
  line.show(progress_bar(share) + " row " + std::to_string(summary.rows) + " of " + std::to_string(faces.face_count()));
}

void run_form_factors(const FormFactorsCommand& command) {
  require_inputs({{InputKind::scene, command.scene}}, command.format);
  require_output(command.output, table_kind, "--output");
  require_output({command.areas, {}}, table_kind, "--areas");
  reserve_stdout_for({command.output.path, command.areas});
  const SceneFile file = read_scene(command.scene, command.format);
  warn(file.warnings);
  const auto start = std::chrono::steady_clock::now();
  const BaseMesh mesh(file.scene, {.join_triangles = false});
  warn(warnings_of(mesh.weld_report()));
  const FacePolygons faces(file.scene, mesh);
  const Blockers blockers(mesh);
  RowsFile out(command.output.path);
  Summary summary{.accuracy = command.options.accuracy};
  {
    StatusLine line;
    form_factor_matrix(faces, blockers, command.options, [&](std::uint32_t from, std::span<const MatrixEntry> row) {
      summary.see(from, row);
      out.write(from, faces.area(from), row);
      if (line.due()) show_progress(line, summary, faces);
    });
  }
  out.finish();
  if (!command.areas.empty()) write_output(command.areas, areas_csv(faces));
  warn(summary.warnings());
  summary.print(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  if (!is_stream(command.output.path)) notes() << "wrote " << command.output.path.string() << '\n';
}

}  // namespace

void add_form_factors_command(CLI::App& app) {
  const auto options = std::make_shared<FormFactorsCommand>();
  CLI::App& command = *app.add_subcommand("form-factors", "Compute the form factors between all faces");
  command.add_option("scene", options->scene, "A scene file; - is stdin")->required()->type_name("SCENE");
  add_format_option(command, options->format);
  add_output_option(command, options->output, table_kind, "Table with lines i,j,F,error_bound,area_i; faces in file order from 0")
      ->required()
      ->type_name("F.csv");
  command.add_option("--areas", options->areas, "Also write a table with lines i,area, one per face of the file")
      ->type_name("A.csv");
  command.add_option("--accuracy", options->options.accuracy, "Absolute error to aim at for each form factor (1e-6)")
      ->check(CLI::Range(1e-12, 0.1));
  command.add_option("--threads", options->options.threads, "Worker threads (as many as the machine has)")->check(whole_from(1));
  command.callback([options] { run_form_factors(*options); });
}

}  // namespace alvor
