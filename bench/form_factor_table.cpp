// form_factor_table form_factors.csv: prints docs/form-factors.md, which compares every method with the exact value for every
// reference geometry.

#include "radiosity/form_factors/closed_forms.h"
#include "radiosity/form_factors/face_form_factor.h"
#include "radiosity/form_factors/form_factor.h"
#include "tests/truth/reference_form_factors.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace {

using namespace alvor;

const char* const head = R"(# Form factors, measured

This page compares each method of `alvor form-factor` with exact values: geometries whose form factors are known to at least nine digits.
`scripts/form_factors.sh` measures and writes it.

- **closed form**: a formula for this kind of geometry.
- **analytic**: a closed contour integral where nothing stands between. Otherwise, the visible part is exact from each point: blockers'
  shadows are cut off, and Lambert's formula sums over the rest. It is integrated adaptively, in cells cut along the lines where shadows
  begin and end.
- **nusselt**: cosine-distributed low-discrepancy rays, in 64 independent sets.
- **hemicube**: 1024 hemicubes of 32 x 32 cells on top, one ray through each cell, weighted by exact delta form factors.

*Error* is relative; a method that saw nothing has an error of 1. *Bound* tells whether the error is within the bound that the method gave.
The analytic method takes its bound from its quadrature. The sampled methods take three standard errors and what no sample may have met;
chance exceeds that now and then.

Rays see float32 geometry and start a hair in front of their surface. In a wedge of a thousandth of a radian (dih-01) that hair counts.

)";

void print_row(const test::ReferenceFormFactor& row, const MeasuredFormFactor& got) {
  const double off = std::abs(got.value - row.value);
  std::printf("| %s | %s | %.9g | %.*s | %.1e | %s | %llu | %.3g |\n", row.name.c_str(), row.kind.c_str(), row.value,
              static_cast<int>(got.method.size()), got.method.data(), row.value > 0 ? off / row.value : off,
              off <= got.error_bound + row.uncertainty + 1e-15 ? "holds" : "**exceeded**",
              static_cast<unsigned long long>(got.rays), 1e3 * got.seconds);
}

template <class Method>
MeasuredFormFactor timed(std::string_view name, Method&& method) {
  const auto start = std::chrono::steady_clock::now();
  MeasuredFormFactor got;
  got.value = method();
  got.error_bound = 1e-13 * got.value;
  got.method = name;
  got.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return got;
}

void print_closed_form(const test::ReferenceFormFactor& row) {
  if (row.kind == "coaxial-disks")
    print_row(row, timed("closed form", [&] { return coaxial_disks(row.number("r1="), row.number("r2="), row.number("L=")); }));
  if (row.kind == "opposed-rects")
    print_row(row,
              timed("closed form", [&] { return opposed_rectangles(row.number("a="), row.number(" b="), row.number("D=")); }));
  if (row.kind == "perp-shared-edge")
    print_row(row, timed("closed form",
                         [&] { return perpendicular_rectangles(row.number("w="), row.number("h="), row.number("l=")); }));
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return std::fputs("usage: form_factor_table form_factors.csv\n", stderr), 2;
  std::fputs(head, stdout);
  std::puts("| geometry | kind | exact | method | error | bound | rays | ms |\n|---|---|---|---|---|---|---|---|");
  for (const auto& row : test::read_reference_form_factors(arguments[1])) {
    print_closed_form(row);
    if (!row.has_polygons()) continue;
    const FaceFormFactors faces(test::scene_of(row), {});
    for (const MeasuredFormFactor& got : {faces.analytic(0, 1), faces.nusselt(0, 1), faces.hemicube(0, 1)}) print_row(row, got);
  }
}
