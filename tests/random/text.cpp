#include "tests/random/text.h"

#include <charconv>
#include <numbers>
#include <sstream>

namespace alvor::test {

namespace {

std::string three(double a, double b, double c, char between = ' ') {
  return exact_text(a) + between + exact_text(b) + between + exact_text(c);
}
std::string three(const Rgb& bands, char between = ' ') { return three(bands.r, bands.g, bands.b, between); }

const char* text(FormFactorMethod method) {
  switch (method) {
    case FormFactorMethod::nusselt: return "nusselt";
    case FormFactorMethod::hemicube: return "hemicube";
    case FormFactorMethod::analytic: return "analytic";
    default: return "auto";
  }
}

}  // namespace

std::string exact_text(double value) {
  char buffer[40];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string obj_text(const Scene& scene) {
  std::ostringstream out;
  out << "mtllib scene.mtl\n";
  for (const Vec3& vertex : scene.vertices) out << "v " << three(vertex.x, vertex.y, vertex.z) << '\n';
  for (const Face& face : scene.faces) {
    if (face.material < scene.materials.size()) out << "usemtl " << scene.materials[face.material].name << '\n';
    if (face.first_corner > scene.corners.size() || face.corner_count > scene.corners.size() - face.first_corner) continue;
    out << 'f';
    for (const std::uint32_t vertex : scene.corners_of(face)) out << ' ' << vertex + 1;
    out << '\n';
  }
  return out.str();
}

std::string mtl_text(const Scene& scene) {
  std::ostringstream out;
  for (const Material& material : scene.materials) {
    out << "newmtl " << material.name << (material.two_sided ? "\n# two-sided" : "") << "\nKd " << three(material.reflectance);
    out << "\nKe " << three((1 / std::numbers::pi) * material.emission) << '\n';
    if (material.texture)
      out << "# has a texture of " << material.texture->image->columns << " x " << material.texture->image->rows << '\n';
    if (material.is_pane()) out << "# lets straight through " << three(material.regular_transmittance) << '\n';
  }
  if (!scene.absorption.is_zero()) out << "# absorption " << three(scene.absorption) << " per metre\n";
  return out.str();
}

std::string command_text(const Trial& trial) {
  const SolveOptions& o = trial.options;
  std::ostringstream out;
  out << "alvor solve scene.obj --tolerance " << exact_text(o.tolerance) << " --max-depth " << o.max_depth << " --max-elements "
      << o.max_leaves << " --threads " << o.threads << " --seed " << o.seed << " --strategy " << text(o.strategy)
      << " --form-factors " << text(o.form_factors);
  if (!trial.scene.absorption.is_zero()) out << " --absorption " << three(trial.scene.absorption, ',');
  if (o.min_edge_m > 0) out << "  # min_edge_m " << exact_text(o.min_edge_m);
  return out.str();
}

}  // namespace alvor::test
