#include "bench/error_vs_time/contest/truth_file.h"

#include "client/verify/irradiance_estimate.h"
#include "import/base/whole_file.h"
#include "solution/patch_id.h"

#include <bit>
#include <cstdio>
#include <sstream>

namespace alvor::bench {

namespace {

/// Hashes all numbers that determine the light of a scene.
class Mixer {
 public:
  void add(std::uint64_t bits) { state_ = mix_bits(state_ + bits + 1); }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(const Vec3& v) { add(v.x), add(v.y), add(v.z); }
  void add(const Rgb& bands) { add(bands.r), add(bands.g), add(bands.b); }
  std::uint64_t mixed() const { return state_; }

 private:
  std::uint64_t state_ = 0;
};

std::uint64_t mixed(const Scene& scene) {
  Mixer mixer;
  for (const Vec3& vertex : scene.vertices) mixer.add(vertex);
  for (const std::uint32_t corner : scene.corners) mixer.add(std::uint64_t{corner});
  for (const Face& face : scene.faces) mixer.add((std::uint64_t{face.corner_count} << 32) + face.material);
  for (const Material& m : scene.materials)
    mixer.add(m.emission), mixer.add(m.reflectance), mixer.add(std::uint64_t{m.two_sided});
  for (const Material& m : scene.materials)
    if (m.is_pane()) mixer.add(m.regular_transmittance);
  mixer.add(scene.absorption);
  return mixer.mixed();
}

std::string line_of(const TruePoint& point) {
  char text[256];
  const auto& [place, normal, face] = point.at;
  std::snprintf(text, sizeof text, "%.17g %.17g %.17g %.17g %.17g %.17g %u %.17g %.17g %d\n", place.x, place.y, place.z, normal.x,
                normal.y, normal.z, face, point.irradiance, point.variance, point.is_hidden ? 1 : 0);
  return text;
}

bool read_point(std::istream& in, TruePoint& point) {
  auto& [place, normal, face] = point.at;
  in >> place.x >> place.y >> place.z >> normal.x >> normal.y >> normal.z >> face;
  return static_cast<bool>(in >> point.irradiance >> point.variance >> point.is_hidden);
}

}  // namespace

std::string truth_question(const Scene& scene, const SceneSettings& settings, std::uint64_t seed) {
  std::ostringstream line;
  line << "irradiance: scene " << std::hex << mixed(scene) << std::dec << ", points " << settings.truth_points << ", paths "
       << settings.truth_paths << ", hidden up to " << slipped_light << " of the mean, seed " << seed;
  return line.str();
}

std::optional<Truth> read_truth(const std::filesystem::path& path, const std::string& question) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  std::istringstream in(read_whole_file(path));
  std::string asked;
  std::size_t count = 0;
  Truth truth;
  if (!std::getline(in, asked) || asked != question || !(in >> count >> truth.paths >> truth.cpu_s)) return std::nullopt;
  truth.was_kept = true;
  for (TruePoint point; truth.points.size() < count && read_point(in, point);) truth.points.push_back(point);
  if (truth.points.size() != count) return std::nullopt;
  return truth;
}

void write_truth(const std::filesystem::path& path, const std::string& question, const Truth& truth) {
  std::filesystem::create_directories(path.parent_path());
  std::ostringstream out;
  out << question << '\n' << truth.points.size() << ' ' << truth.paths << ' ' << truth.cpu_s << '\n';
  for (const TruePoint& point : truth.points) out << line_of(point);
  write_whole_file(path, out.str());
}

}  // namespace alvor::bench
