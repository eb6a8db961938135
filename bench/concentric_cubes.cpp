// concentric_cubes NU NV INNER: prints an OBJ of a unit cube around a cube of side INNER, every face cut into NU x NV quads.

#include <array>
#include <cstdio>
#include <cstdlib>

namespace {

struct Point {
  double x, y, z;
};

/// Prints face `n` of a cube about (0.5, 0.5, 0.5): n / 2 is the axis, n % 2 selects low or high. Faces with `inwards` face the
/// centre.
void print_face(int n, double side, bool inwards, int nu, int nv) {
  const int axis = n / 2;
  const bool is_high = n % 2 == 1, flip = is_high == inwards;
  const auto at = [&](double u, double v) {
    std::array<double, 3> p{};
    p[static_cast<std::size_t>(axis)] = 0.5 + (is_high ? 0.5 : -0.5) * side;
    p[static_cast<std::size_t>((axis + 1) % 3)] = 0.5 + (u - 0.5) * side;
    p[static_cast<std::size_t>((axis + 2) % 3)] = 0.5 + (v - 0.5) * side;
    return Point{p[0], p[1], p[2]};
  };
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j) {
      const double u0 = double(i) / nu, u1 = double(i + 1) / nu, v0 = double(j) / nv, v1 = double(j + 1) / nv;
      for (const Point& p : {at(u0, v0), at(u1, v0), at(u1, v1), at(u0, v1)}) std::printf("v %.17g %.17g %.17g\n", p.x, p.y, p.z);
      std::puts(flip ? "f -1 -2 -3 -4" : "f -4 -3 -2 -1");
    }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return std::fputs("usage: concentric_cubes NU NV INNER\n", stderr), 2;
  const int nu = std::atoi(arguments[1]), nv = std::atoi(arguments[2]);
  for (int n = 0; n < 6; ++n) print_face(n, 1, true, nu, nv);
  for (int n = 0; n < 6; ++n) print_face(n, std::atof(arguments[3]), false, nu, nv);
}
