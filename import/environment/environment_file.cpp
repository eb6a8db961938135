#include "import/environment/environment_file.h"

#include "import/base/import_error.h"
#include "import/environment/exr_file.h"
#include "import/environment/radiance_file.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace alvor {

namespace {

#ifdef ALVOR_FUZZING
constexpr std::int64_t most_columns = 1024, most_rows = 512;  // a fuzzer soon asks for the most, and would only fill memory
#else
constexpr std::int64_t most_columns = 16384, most_rows = 8192;
#endif
constexpr double largest_skew = 0.02;
constexpr float most_radiance = 1e30f;

/// Checks the rows of an image and reduces them to the working size.
class CheckedRows final : public ImageRows {
 public:
  void begin(std::int64_t columns, std::int64_t rows) override {
    const std::string size = std::to_string(columns) + " x " + std::to_string(rows) + " pixels";
    if (columns <= 0 || rows <= 0) throw ImportError("size", size);
    if (columns > most_columns || rows > most_rows)
      throw ImportError("size", size + ", at most " + std::to_string(most_columns) + " x " + std::to_string(most_rows));
    if (std::abs(double(columns) / double(rows) / 2 - 1) > largest_skew)
      throw ImportError("size", size + ": an equirectangular image is twice as wide as high");
    const SphereGrid from{static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows)};
    reduction_.emplace(from, SphereGrid{std::min(from.columns, working_columns), std::min(from.rows, working_rows)});
  }
  void add(std::span<float> rgb) override {
    for (std::size_t n = 0; n < rgb.size(); ++n) {
      if (!(rgb[n] <= most_radiance && rgb[n] >= -most_radiance)) refuse(rgb[n], n / 3);
      negative_ += rgb[n] < 0;
      rgb[n] = std::max(0.0f, rgb[n]);
      is_lit_ |= rgb[n] > 0;
    }
    reduction_->add_row(rgb);
    ++row_;
  }
  EnvironmentFile take() {
    std::vector<std::string> warnings;
    if (negative_ > 0)
      warnings.push_back(std::to_string(negative_) +
                         (negative_ == 1 ? " value is negative and counts as 0" : " values are negative and count as 0"));
    if (!is_lit_) warnings.push_back("is black: it brings no light");
    return {reduction_->take(), std::move(warnings)};
  }

 private:
  [[noreturn]] void refuse(float value, std::size_t column) const {
    const char* what = std::isnan(value) ? "is not a number" : std::isinf(value) ? "is infinite" : "is beyond 1e30";
    throw ImportError("row " + std::to_string(row_) + ", column " + std::to_string(column), std::string("its value ") + what);
  }

  std::optional<EnvironmentReduction> reduction_;
  std::size_t row_ = 0, negative_ = 0;
  bool is_lit_ = false;
};

}  // namespace

EnvironmentFile read_environment(const std::string& bytes, std::string_view extension) {
  CheckedRows rows;
  if (bytes.empty()) throw ImportError("file", "is empty");
  if (extension == ".hdr") read_radiance(bytes, rows);
  else read_exr(bytes, rows);
  return rows.take();
}

}  // namespace alvor
