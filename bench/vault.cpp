// vault DIR: writes vault.obj and .mtl, a room under a luminous ceiling with a vaulted alcove, a sphere, a ring and a vase, all
// made of triangles. The output is always the same. Lengths are metres, y is up.

#include "bench/scene_program.h"

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

namespace alvor::bench {

namespace {

constexpr std::array paints{Paint{"wall", "Kd 0.76 0.73 0.67"},    Paint{"floor", "Kd 0.42 0.38 0.34"},
                            Paint{"plaster", "Kd 0.82 0.79 0.72"}, Paint{"sand", "Kd 0.72 0.55 0.36"},
                            Paint{"marble", "Kd 0.80 0.80 0.78"},  Paint{"copper", "Kd 0.70 0.36 0.20"},
                            Paint{"glaze", "Kd 0.12 0.30 0.46"},   Paint{"ceiling", "Kd 0.2 0.2 0.2\nKe 3 3 3"}};

constexpr double pi = std::numbers::pi;
constexpr double half_wide = 3, height = 3.6, depth = 5;                  // dimensions of the room
constexpr double arch_radius = 1.25, springing = 1.6, alcove_deep = 2.5;  // dimensions of the alcove behind the room's wall z = 0
constexpr int arch_steps = 24, alcove_steps = 8;

using Surface = std::function<Vec3(double u, double v)>;  // u and v from 0 to 1

void add_triangle(ObjWriter& obj, const char* material, const std::array<int, 3>& ring) { obj.face(material, ring); }

/// Adds a surface as a grid of triangles. Fronts face along u x v. A side that shrinks to a point keeps one triangle of each two.
void add_surface(ObjWriter& obj, const char* material, int columns, int rows, const Surface& at) {
  const auto point = [&](int column, int row) { return at(double(column) / columns, double(row) / rows); };
  std::vector<int> names;
  for (int row = 0; row <= rows; ++row)
    for (int column = 0; column <= columns; ++column) names.push_back(obj.vertex(point(column, row)));
  const auto name = [&](int column, int row) { return names[static_cast<std::size_t>(row * (columns + 1) + column)]; };
  const auto apart = [&](int row) { return length(point(1, row) - point(0, row)) > 1e-6; };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int a = name(column, row), b = name(column + 1, row), c = name(column + 1, row + 1), d = name(column, row + 1);
      if (apart(row)) add_triangle(obj, material, {a, b, d});
      if (apart(row + 1)) add_triangle(obj, material, {b, c, d});
    }
}

/// Adds the parallelogram at `corner`; its front faces along `along` x `up`.
void add_plane(ObjWriter& obj, const char* material, Vec3 corner, Vec3 along, Vec3 up, int columns = 1, int rows = 1) {
  add_surface(obj, material, columns, rows, [=](double u, double v) { return corner + along * u + up * v; });
}

/// Returns a point on the arch, from the left springer (u = 0) over the crown to the right one (u = 1).
Vec3 on_arch(double u, double z) { return {-arch_radius * std::cos(pi * u), springing + arch_radius * std::sin(pi * u), z}; }

void add_room(ObjWriter& obj) {
  const Vec3 x{2 * half_wide, 0, 0}, y{0, height, 0}, z{0, 0, depth};
  const Vec3 origin{-half_wide, 0, 0};
  add_plane(obj, "floor", origin, z, x);
  add_plane(obj, "ceiling", origin + y, x, z);
  add_plane(obj, "wall", origin, y, z);
  add_plane(obj, "wall", origin + x, z, y);
  add_plane(obj, "wall", origin + z, y, x);
}

/// Adds the wall around the alcove, cut at the height of the springing so that its pieces share whole edges.
void add_arched_wall(ObjWriter& obj) {
  const Vec3 beside{half_wide - arch_radius, 0, 0}, below{0, springing, 0}, above{0, height - springing, 0};
  for (const double x : {-half_wide, arch_radius}) {
    add_plane(obj, "wall", {x, 0, 0}, beside, below);
    add_plane(obj, "wall", {x, springing, 0}, beside, above);
  }
  add_surface(obj, "wall", arch_steps, 3, [](double u, double v) {
    const Vec3 low = on_arch(u, 0);
    return lerp(low, {low.x, height, 0}, v);
  });
}

void add_alcove(ObjWriter& obj) {
  const Vec3 inwards{0, 0, -alcove_deep}, up{0, springing, 0}, across{2 * arch_radius, 0, 0};
  const Vec3 left{-arch_radius, 0, 0}, right{arch_radius, 0, 0};
  add_plane(obj, "floor", left, across, inwards);
  add_plane(obj, "sand", left, inwards, up, alcove_steps, 4);
  add_plane(obj, "sand", right + inwards, -inwards, up, alcove_steps, 4);
  add_plane(obj, "sand", left + inwards, across, up);
  add_surface(obj, "plaster", alcove_steps, arch_steps, [](double u, double v) { return on_arch(v, -alcove_deep * u); });
  add_surface(obj, "sand", 4, arch_steps / 2,
              [](double u, double v) { return lerp(on_arch(v / 2, -alcove_deep), on_arch(1 - v / 2, -alcove_deep), u); });
}

/// Adds a profile (radius and height by row) turned about the vertical. Fronts face outwards where the profile climbs. Each row
/// is half a step ahead of the one below: then no two triangles lie in one plane, which importers would join to a quad.
void add_turned(ObjWriter& obj, const char* material, int columns, int rows,
                const std::function<std::array<double, 2>(int)>& profile) {
  add_surface(obj, material, columns, rows, [&](double u, double v) {
    const int row = static_cast<int>(std::lround(v * rows));
    const auto [radius, y] = profile(row);
    const double angle = 2 * pi * (u + 0.5 * row / columns);
    return Vec3{radius * std::cos(angle), y, -radius * std::sin(angle)};
  });
}

/// Adds a ring that lies on the floor.
void add_ring(ObjWriter& obj, const Place& place) {
  constexpr int rows = 18;  // smooth: it turns less than 25 degrees per row
  obj.stand_at(place);
  add_turned(obj, "copper", 28, rows, [](int row) {
    const double angle = 2 * pi * row / rows;
    return std::array{0.6 + 0.18 * std::sin(angle), 0.18 - 0.18 * std::cos(angle)};
  });
}

/// Adds a vase: the profile goes up the outside, over the rim and down the inside to the middle of the bottom.
void add_vase(ObjWriter& obj, const Place& place) {
  constexpr std::array<std::array<double, 2>, 15> profile{{{0.14, 0},
                                                           {0.21, 0.08},
                                                           {0.28, 0.22},
                                                           {0.31, 0.38},
                                                           {0.28, 0.54},
                                                           {0.19, 0.68},
                                                           {0.12, 0.80},
                                                           {0.13, 0.90},
                                                           {0.20, 0.97},
                                                           {0.18, 0.985},
                                                           {0.11, 0.90},
                                                           {0.10, 0.80},
                                                           {0.25, 0.54},
                                                           {0.24, 0.22},
                                                           {0, 0.06}}};
  obj.stand_at(place);
  add_turned(obj, "glaze", 20, 14, [&](int row) { return profile[static_cast<std::size_t>(row)]; });
}

void add_block(ObjWriter& obj, const char* material, Vec3 low, Vec3 high) {
  const Vec3 x{high.x - low.x, 0, 0}, y{0, high.y - low.y, 0}, z{0, 0, high.z - low.z};
  add_plane(obj, material, low + y, z, x);
  add_plane(obj, material, low, z, y);
  add_plane(obj, material, low + x, y, z);
  add_plane(obj, material, low, y, x);
  add_plane(obj, material, low + z, x, y);
}

/// A sphere made from an icosahedron whose triangles are cut in four twice and moved outwards; it rests on a vertex.
class Sphere {
 public:
  explicit Sphere(ObjWriter& obj) : obj_(obj) {}

  void add(const char* material, Vec3 centre, double radius) {
    constexpr double g = std::numbers::phi;
    constexpr std::array<Vec3, 12> corners{{{-1, g, 0},
                                            {1, g, 0},
                                            {-1, -g, 0},
                                            {1, -g, 0},
                                            {0, -1, g},
                                            {0, 1, g},
                                            {0, -1, -g},
                                            {0, 1, -g},
                                            {g, 0, -1},
                                            {g, 0, 1},
                                            {-g, 0, -1},
                                            {-g, 0, 1}}};
    constexpr std::array<std::array<int, 3>, 20> faces{
        {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
         {3, 9, 4},  {3, 4, 2}, {3, 2, 6}, {3, 6, 8},  {3, 8, 9},   {4, 9, 5}, {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}}};
    material_ = material, centre_ = centre, radius_ = radius;
    const auto corner = [&](int n) { return normalized(corners[static_cast<std::size_t>(n)]); };
    for (const auto& [a, b, c] : faces) cut(corner(a), corner(b), corner(c), 2);
  }

 private:
  void cut(Vec3 a, Vec3 b, Vec3 c, int times) {
    if (times == 0) return add_triangle(obj_, material_, {vertex(a), vertex(b), vertex(c)});
    const Vec3 ab = normalized(a + b), bc = normalized(b + c), ca = normalized(c + a);
    cut(a, ab, ca, times - 1);
    cut(ab, b, bc, times - 1);
    cut(ca, bc, c, times - 1);
    cut(ab, bc, ca, times - 1);
  }

  int vertex(Vec3 direction) {
    const auto whole = [](double x) { return std::lround(1e6 * x); };
    const auto [slot, is_new] = names_.try_emplace({whole(direction.x), whole(direction.y), whole(direction.z)});
    if (is_new) slot->second = obj_.vertex(centre_ + direction * radius_);
    return slot->second;
  }

  ObjWriter& obj_;
  const char* material_ = "";
  Vec3 centre_;
  double radius_ = 1;
  std::map<std::array<long, 3>, int> names_;
};

ObjWriter vault() {
  ObjWriter obj;
  add_room(obj);
  add_arched_wall(obj);
  add_alcove(obj);
  add_block(obj, "sand", {-0.4, 0, -1.6}, {0.4, 0.5, -0.8});
  Sphere(obj).add("marble", {0, 1.0, -1.2}, 0.5);
  add_ring(obj, {0.7, 2.0, 10});
  add_vase(obj, {2.1, 0.8});
  return obj;
}

}  // namespace

}  // namespace alvor::bench

int main(int count, char** arguments) {
  using namespace alvor::bench;
  return run_scene_program(count, arguments, "vault", paints, vault);
}
