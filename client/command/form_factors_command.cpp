// alvor form-factors SCENE -o F.csv: between all faces.

#include "client/command/commands.h"
#include "client/command/failure.h"
#include "client/command/files.h"
#include "client/command/numbers.h"
#include "client/command/option_checks.h"
#include "client/command/outputs.h"
#include "client/scene_file.h"
#include "radiosity/form_factor_matrix.h"

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
  std::filesystem::path output;
  MatrixOptions options;
};

/// What is worth telling of a matrix, row by row.
struct Summary {
  std::size_t rows = 0, entries = 0;
  double lowest = 1, highest = 0, sum_of_sums = 0, largest_bound = 0;

  void see(std::span<const MatrixEntry> row) {
    double sum = 0;
    for (const MatrixEntry& entry : row) {
      sum += entry.value;
      largest_bound = std::max(largest_bound, entry.error_bound);
    }
    ++rows;
    entries += row.size();
    lowest = std::min(lowest, sum), highest = std::max(highest, sum), sum_of_sums += sum;
  }
};

void append_row(std::string& text, std::uint32_t from, std::span<const MatrixEntry> row) {
  for (const MatrixEntry& entry : row)
    text += std::to_string(from) + "," + std::to_string(entry.to) + "," + shortest(entry.value) + "," +
            shortest(entry.error_bound) + "\n";
}

/// Written beside its name and moved there when complete, for it may be larger than memory.
class RowsFile {
 public:
  explicit RowsFile(const std::filesystem::path& path) : path_(path), part_(path.string() + ".part"), out_(part_) {
    out_ << "i,j,F,error_bound\n";
  }
  ~RowsFile() {
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
  }
  void write(std::uint32_t from, std::span<const MatrixEntry> row) {
    text_.clear();
    append_row(text_, from, row);
    out_ << text_;
    if (!out_) throw Failure(ExitStatus::failed, path_.string() + ": could not be written");
  }
  void finish() {
    out_.close();
    if (!out_) throw Failure(ExitStatus::failed, path_.string() + ": could not be written");
    std::filesystem::rename(part_, path_);
  }

 private:
  std::filesystem::path path_, part_;
  std::ofstream out_;
  std::string text_;
};

void run_form_factors(const FormFactorsCommand& command) {
  require_writable(command.output, "--output");
  const SceneFile file = read_scene_file(command.scene);
  warn(file.warnings);
  const auto start = std::chrono::steady_clock::now();
  const BaseMesh mesh(file.scene);
  const FacePolygons faces(file.scene, mesh);
  const Blockers blockers(mesh);
  RowsFile out(command.output);
  Summary summary;
  form_factor_matrix(faces, blockers, command.options, [&](std::uint32_t from, std::span<const MatrixEntry> row) {
    summary.see(row);
    out.write(from, row);
  });
  out.finish();
  const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::cout << summary.rows << " faces, " << summary.entries << " form factors, " << seconds(spent) << '\n'
            << "row sums from " << shortest(summary.lowest) << " to " << shortest(summary.highest) << ", mean "
            << shortest(summary.sum_of_sums / static_cast<double>(std::max<std::size_t>(1, summary.rows))) << '\n'
            << "largest error bound " << shortest(summary.largest_bound) << '\n'
            << "wrote " << command.output.string() << '\n';
}

}  // namespace

void add_form_factors_command(CLI::App& app) {
  const auto options = std::make_shared<FormFactorsCommand>();
  CLI::App& command = *app.add_subcommand("form-factors", "The form factors between all faces");
  command.add_option("scene", options->scene, "A scene file")->required()->type_name("SCENE");
  command.add_option("-o,--output", options->output, "Lines i,j,F,error_bound; faces in file order from 0")
      ->required()
      ->type_name("F.csv");
  command.add_option("--accuracy", options->options.accuracy, "Absolute, aimed at for each (1e-6)")
      ->check(CLI::Range(1e-12, 0.1));
  command.add_option("--threads", options->options.threads, "Worker threads (as many as the machine has)")->check(whole_from(1));
  command.callback([options] { run_form_factors(*options); });
}

}  // namespace alvor
