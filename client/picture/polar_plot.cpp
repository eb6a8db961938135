#include "client/picture/polar_plot.h"

#include "client/picture/drawing.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>

namespace alvor {

namespace {

using std::numbers::pi;

constexpr int width = 720, height = 780;
constexpr double middle_x = 360, middle_y = 380, outer_radius = 290;
constexpr int rings = 4, rays = 12, points_of_curve = 720;

/// Returns a round number, at least `value`, that `rings` steps reach: 1, 2, 2.5 or 5 times a power of ten per step.
double step_of_rings(double value) {
  const double least = value / rings, power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 2.5, 5.0})
    if (factor * power >= least) return factor * power;
  return 10 * power;
}

std::string text_of(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// A drawing of one luminaire.
class PolarPlot {
 public:
  explicit PolarPlot(const LuminaireFile& luminaire)
      : luminaire_(luminaire),
        surface_(new_drawing(width, height)),
        cairo_(cairo_create(surface_.get()), cairo_destroy),
        step_(step_of_rings(luminaire.web->greatest())) {
    if (cairo_status(cairo_.get()) != CAIRO_STATUS_SUCCESS) throw std::runtime_error("no memory for a drawing");
    cairo_set_source_rgb(cairo_.get(), 1, 1, 1);
    cairo_paint(cairo_.get());
    cairo_select_font_face(cairo_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  }

  Image draw() {
    draw_grid();
    const double dash[]{9, 6};
    cairo_set_line_width(cairo_.get(), 2.5);
    if (luminaire_.symmetry != "axial") {
      cairo_set_dash(cairo_.get(), dash, 2, 0);
      cairo_set_source_rgb(cairo_.get(), 0.1, 0.35, 0.75);
      draw_curve({0, 1, 0});
    }
    cairo_set_dash(cairo_.get(), nullptr, 0, 0);
    cairo_set_source_rgb(cairo_.get(), 0.8, 0.2, 0.1);
    draw_curve({1, 0, 0});
    draw_text();
    return image_of(surface_.get());
  }

 private:
  void draw_grid() {
    cairo_set_line_width(cairo_.get(), 1);
    for (int ring = 1; ring <= rings; ++ring) {
      cairo_set_source_rgb(cairo_.get(), 0.75, 0.75, 0.75);
      cairo_new_sub_path(cairo_.get());
      cairo_arc(cairo_.get(), middle_x, middle_y, outer_radius * ring / rings, 0, 2 * pi);
      cairo_stroke(cairo_.get());
      write(middle_x + 4, middle_y - outer_radius * ring / rings - 4, 13, text_of("%g", ring * step_));
    }
    for (int ray = 0; ray < rays; ++ray) {
      const double angle = 2 * pi * ray / rays, x = std::sin(angle), y = std::cos(angle);
      cairo_set_source_rgb(cairo_.get(), 0.75, 0.75, 0.75);
      cairo_move_to(cairo_.get(), middle_x, middle_y);
      cairo_line_to(cairo_.get(), middle_x + outer_radius * x, middle_y + outer_radius * y);
      cairo_stroke(cairo_.get());
      const double degrees = 360.0 * std::min(ray, rays - ray) / rays;
      write(middle_x + (outer_radius + 22) * x - 14, middle_y + (outer_radius + 22) * y + 5, 13, text_of("%g\u00b0", degrees));
    }
  }
  void draw_curve(Vec3 side) {
    for (int n = 0; n <= points_of_curve; ++n) {
      const double angle = 2 * pi * n / points_of_curve;
      const double far = luminaire_.web->intensity(std::sin(angle) * side + Vec3{0, 0, std::cos(angle)}) / (rings * step_);
      const double x = middle_x + outer_radius * far * std::sin(angle), y = middle_y + outer_radius * far * std::cos(angle);
      if (n == 0) cairo_move_to(cairo_.get(), x, y);
      else cairo_line_to(cairo_.get(), x, y);
    }
    cairo_stroke(cairo_.get());
  }
  void draw_text() {
    write(24, 34, 19, luminaire_.name.substr(0, 60));
    const std::string axial = luminaire_.symmetry == "axial" ? "all planes" : "C 0-180 solid, C 90-270 dashed";
    write(24, height - 20, 15, text_of("%.4g lm", luminaire_.lumens) + ", rings in cd, " + axial);
  }
  void write(double x, double y, double size, const std::string& text) {
    cairo_set_source_rgb(cairo_.get(), 0.2, 0.2, 0.2);
    cairo_set_font_size(cairo_.get(), size);
    cairo_move_to(cairo_.get(), x, y);
    cairo_show_text(cairo_.get(), text.c_str());
  }
  const LuminaireFile& luminaire_;
  CairoSurface surface_;
  CairoContext cairo_;
  double step_;  // cd between rings
};

}  // namespace

Image draw_polar_curves(const LuminaireFile& luminaire) { return PolarPlot(luminaire).draw(); }

}  // namespace alvor
