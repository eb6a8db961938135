#include "import/formats/emission_textures.h"

#include "meshing/ear_clipping.h"
#include "meshing/polygon.h"
#include "meshing/texture_mean.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <span>
#include <utility>

namespace alvor {

namespace {

// Cutting ends when the light that would be moved by more of it is below this share of all, and at this number of cuts, each of
// which makes four triangles of one. Chosen: a picture on a screen gets some hundred pieces.
constexpr double moved_share = 0.02;
constexpr std::size_t most_cuts = 1024;
// Emission below this share of the largest is dark, as the noise of a JPEG file in black places; the rest gets its power.
constexpr double dark_share = 1e-3;
// Most copies of one material.
constexpr std::size_t most_copies = 64;

struct Corner {
  std::uint32_t vertex = 0;
  TexturePoint on_light, on_colour;
  RgbF colour;
};

/// A triangle of a face.
struct Cell {
  std::uint32_t face = 0;
  std::array<Corner, 3> corners;
  double area = 0;
  Rgb emission;      // mean over the triangle
  double moved = 0;  // power that an even emission has in the wrong sixteenths of the triangle
  std::uint32_t material = 0;
};

TexturePoint middle(TexturePoint a, TexturePoint b) { return {(a.s + b.s) / 2, (a.t + b.t) / 2}; }

using Points = std::array<TexturePoint, 3>;

/// Returns the four triangles between the corners of a triangle and the middles of its edges.
template <class Place, class Middle>
std::array<std::array<Place, 3>, 4> quarters(const std::array<Place, 3>& whole, Middle middle_of) {
  const Place ab = middle_of(whole[0], whole[1]), bc = middle_of(whole[1], whole[2]), ca = middle_of(whole[2], whole[0]);
  return {{{whole[0], ab, ca}, {ab, whole[1], bc}, {ca, bc, whole[2]}, {bc, ca, ab}}};
}

double sum_of_differences(const Rgb& a, const Rgb& b) { return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b); }

/// Returns a divided by b, band by band; 0 where b is 0.
Rgb ratio(const Rgb& a, const Rgb& b) {
  const auto of = [](double x, double y) { return y > 0 ? x / y : 0; };
  return {of(a.r, b.r), of(a.g, b.g), of(a.b, b.b)};
}

/// Cuts faces with one image.
class FaceCutter {
 public:
  FaceCutter(Scene& scene, const ColourImage& image, Wrap wrap_s, Wrap wrap_t, const Rgb& emission)
      : scene_(scene),
        image_(image),
        wrap_s_(wrap_s),
        wrap_t_(wrap_t),
        mean_(image, light_of_texel),
        factor_(ratio(emission, mean_surface(image, light_of_texel).reflectance)) {}

  /// Adds a face that has an area; returns whether it has. Requires: a point for each corner of the face.
  bool add(std::uint32_t number, std::span<const TexturePoint> points) {
    const Face& face = scene_.faces[number];
    std::vector<Vec3> polygon;
    for (const std::uint32_t vertex : scene_.corners_of(face)) polygon.push_back(scene_.vertices[vertex]);
    const Vec3 double_area = double_area_vector(polygon);
    if (!(length(double_area) > 0 && std::isfinite(length(double_area)))) return false;
    for (const auto& triangle : clip_ears(polygon, normalized(double_area))) {
      std::array<Corner, 3> corners;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at = face.first_corner + triangle[c];
        corners[c] = {scene_.corners[at], points[triangle[c]],
                      scene_.texture_points.empty() ? TexturePoint{} : scene_.texture_points[at],
                      scene_.corner_colours.empty() ? RgbF{1, 1, 1} : scene_.corner_colours[at]};
      }
      cells_.push_back(cell(number, corners));
    }
    return true;
  }

  /// Cuts the cells that move most power until little is moved. Returns all of them.
  std::vector<Cell> cut() {
    double power = 0, moved = 0;
    for (const Cell& next : cells_) power += next.area * next.emission.sum(), moved += next.moved;
    const auto moves_less = [&](std::size_t a, std::size_t b) { return cells_[a].moved < cells_[b].moved; };
    std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(moves_less)> queue(moves_less);
    for (std::size_t n = 0; n < cells_.size(); ++n) queue.push(n);
    for (std::size_t cuts = 0; cuts < most_cuts && moved > moved_share * power; ++cuts) {
      const std::size_t place = queue.top();
      queue.pop();
      const Cell whole = cells_[place];
      moved -= whole.moved;
      const auto parts = quarters(whole.corners, [&](const Corner& a, const Corner& b) { return middle_of(a, b); });
      for (std::size_t part = 0; part < parts.size(); ++part) {
        const std::size_t n = part == 0 ? place : cells_.size();
        if (part > 0) cells_.emplace_back();
        cells_[n] = cell(whole.face, parts[part]);
        moved += cells_[n].moved;
        queue.push(n);
      }
    }
    return std::move(cells_);
  }

 private:
  Cell cell(std::uint32_t face, const std::array<Corner, 3>& corners) const {
    const auto at = [&](std::size_t c) { return scene_.vertices[corners[c].vertex]; };
    const Points points{corners[0].on_light, corners[1].on_light, corners[2].on_light};
    const double area = length(cross(at(1) - at(0), at(2) - at(0))) / 2;
    Cell made{face, corners, std::isfinite(area) ? area : 0, emission_over(points)};  // what is not finite is a fault found later
    for (const Points& quarter : quarters(points, middle))
      for (const Points& part : quarters(quarter, middle))
        made.moved += made.area / 16 * sum_of_differences(emission_over(part), made.emission);
    return made;
  }

  Rgb emission_over(const Points& points) const {
    std::array<TexelPoint, 3> polygon;
    for (std::size_t c = 0; c < 3; ++c) polygon[c] = {double{points[c].s} * image_.columns, double{points[c].t} * image_.rows};
    return factor_ * mean_.over(polygon, wrap_s_, wrap_t_).reflectance;
  }

  Corner middle_of(const Corner& a, const Corner& b) {
    const std::pair<std::uint32_t, std::uint32_t> edge = std::minmax(a.vertex, b.vertex);
    const auto [found, is_new] = middles_.try_emplace(edge, static_cast<std::uint32_t>(scene_.vertices.size()));
    if (is_new) scene_.vertices.push_back(0.5 * (scene_.vertices[edge.first] + scene_.vertices[edge.second]));
    return {found->second, middle(a.on_light, b.on_light), middle(a.on_colour, b.on_colour), 0.5F * (a.colour + b.colour)};
  }

  Scene& scene_;
  const ColourImage& image_;
  const Wrap wrap_s_, wrap_t_;
  const TextureMean mean_;
  const Rgb factor_;  // from a value of the image to emission
  std::vector<Cell> cells_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles_;  // vertices in the middles of edges
};

/// The cells of one material by their emission: those of a group are nearly alike.
using Level = std::array<int, 3>;
using Groups = std::map<Level, std::vector<Cell*>>;

/// Returns groups of cells, at most as many as a material may have copies. Dark cells are the group {0, 0, 0}.
Groups group_by_emission(std::span<Cell> cells) {
  double largest = 0;
  for (const Cell& cell : cells) largest = std::max(largest, cell.emission.max());
  for (int levels = 15;; levels /= 2) {
    const auto level_of = [&](double band) { return static_cast<int>(std::lround(levels * std::cbrt(band / largest))); };
    Groups groups;
    for (Cell& cell : cells) {
      const bool is_dark = !(cell.emission.max() >= dark_share * largest) || largest == 0;
      Level level{};
      if (!is_dark) level = {level_of(cell.emission.r), level_of(cell.emission.g), level_of(cell.emission.b)};
      if (!is_dark && level == Level{}) level = {1, 1, 1};
      groups[level].push_back(&cell);
    }
    if (groups.size() <= most_copies || levels == 1) return groups;
  }
}

/// Gives each group of cells a copy of a material with its mean emission. The first group gets the material itself if that is
/// `free`.
void give_materials(Scene& scene, std::uint32_t material, const Groups& groups, bool is_free) {
  const auto sum = [](const std::vector<Cell*>& cells) {
    std::pair<Rgb, double> light_and_area;
    for (const Cell* cell : cells) light_and_area.first += cell->area * cell->emission, light_and_area.second += cell->area;
    return light_and_area;
  };
  double all = 0, kept = 0;
  for (const auto& [level, cells] : groups) {
    const double power = sum(cells).first.sum();
    all += power;
    if (level != Level{}) kept += power;
  }
  int copies = 0;
  for (const auto& [level, cells] : groups) {
    const auto [light, area] = sum(cells);
    Rgb emission;
    if (level != Level{} && area > 0) emission = all / kept / area * light;
    std::uint32_t own = material;
    if (!std::exchange(is_free, false)) {
      own = static_cast<std::uint32_t>(scene.materials.size());
      Material copy = scene.materials[material];
      copy.name += ", light " + std::to_string(++copies);
      scene.materials.push_back(std::move(copy));
    }
    scene.materials[own].emission = emission;
    for (Cell* cell : cells) cell->material = own;
  }
}

/// Replaces faces by their cells, unless these have one material: then the face gets it.
void replace_faces(Scene& scene, const std::map<std::uint32_t, std::vector<Cell>>& cells_of) {
  const std::vector<Face> faces = std::exchange(scene.faces, {});
  std::vector<std::uint32_t> moved_to;
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    moved_to.push_back(static_cast<std::uint32_t>(scene.faces.size()));
    const auto found = cells_of.find(f);
    if (found == cells_of.end()) {
      scene.faces.push_back(faces[f]);
      continue;
    }
    const std::vector<Cell>& cells = found->second;
    const auto is_like_first = [&](const Cell& cell) { return cell.material == cells[0].material; };
    if (std::ranges::all_of(cells, is_like_first)) {
      scene.faces.push_back({faces[f].first_corner, faces[f].corner_count, cells[0].material});
      continue;
    }
    for (const Cell& cell : cells) {
      const auto all = [&](auto member) {
        return std::array{cell.corners[0].*member, cell.corners[1].*member, cell.corners[2].*member};
      };
      const auto points = all(&Corner::on_colour);
      const auto colours = all(&Corner::colour);
      scene.add_face(all(&Corner::vertex), cell.material, std::span(points).first(scene.texture_points.empty() ? 0 : 3),
                     std::span(colours).first(scene.corner_colours.empty() ? 0 : 3));
    }
  }
  moved_to.push_back(static_cast<std::uint32_t>(scene.faces.size()));
  for (SceneObject& object : scene.objects) {
    const std::uint32_t end = moved_to[object.first_face + object.face_count];
    object.first_face = moved_to[object.first_face];
    object.face_count = end - object.first_face;
  }
}

}  // namespace

void EmissionTextures::set(std::uint32_t material, std::shared_ptr<const ColourImage> image, Wrap wrap_s, Wrap wrap_t) {
  textures_.emplace(material, Texture{std::move(image), wrap_s, wrap_t});
}

void EmissionTextures::place(const Scene& scene, std::span<const TexturePoint> points, const Placement& placement) {
  std::vector<TexturePoint> in_order(points.begin(), points.end());
  if (placement.mirrors()) std::reverse(in_order.begin() + 1, in_order.end());
  place(static_cast<std::uint32_t>(scene.faces.size() - 1), std::move(in_order));
}

void EmissionTextures::cut(Scene& scene, std::vector<std::string>& warnings) const {
  std::map<std::uint32_t, std::vector<std::uint32_t>> placed_of;  // by material: numbers in faces_
  for (std::uint32_t n = 0; n < faces_.size(); ++n) placed_of[scene.faces[faces_[n].face].material].push_back(n);
  std::map<std::uint32_t, std::vector<Cell>> cells_of;  // by face
  for (const auto& [material, placed] : placed_of) {
    const auto texture = textures_.find(material);
    // An emission that is not finite is a fault that is found later.
    if (texture == textures_.end() || !scene.materials[material].emission.is_finite()) continue;
    FaceCutter cutter(scene, *texture->second.image, texture->second.wrap_s, texture->second.wrap_t,
                      scene.materials[material].emission);
    std::ptrdiff_t added = 0;
    for (const std::uint32_t n : placed) added += cutter.add(faces_[n].face, faces_[n].points);
    std::vector<Cell> cells = cutter.cut();
    const auto faces = std::ranges::count(scene.faces, material, &Face::material);
    const Groups groups = group_by_emission(cells);
    give_materials(scene, material, groups, faces == added);
    warnings.push_back("material '" + scene.materials[material].name + "': its emissive texture counts as " +
                       std::to_string(groups.size()) + " even emissions on " + std::to_string(cells.size()) + " triangles");
    for (Cell& cell : cells) cells_of[cell.face].push_back(std::move(cell));
  }
  if (!cells_of.empty()) replace_faces(scene, cells_of);
}

}  // namespace alvor
