#include "client/report/isolux.h"

#include "client/picture/drawing.h"
#include "client/picture/legend.h"
#include "client/picture/round_number.h"
#include "client/picture/tone_map.h"
#include "meshing/opening_face.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace alvor {

namespace {

constexpr int longer_side = 900, least_side = 280, margin = 24, foot = 44;  // pixels
constexpr int most_curves = 12;
constexpr std::uint8_t paper = 255, border_grey = 225;

/// Returns what numbers at grid points are written as.
std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value >= 100 ? "%.0f" : "%.3g", value);
  return text;
}

/// Draws one plan.
class Plan {
 public:
  explicit Plan(const IsoluxPlan& plan)
      : plan_(plan),
        room_(plan.room),
        field_(plan.room, plan.grid, plan.values),
        scale_(plan.scale.value_or(scale_of(plan.values))) {
    const double wide = room_.raster.columns * room_.raster.cell_u, high = room_.raster.rows * room_.raster.cell_v;
    pixels_ = longer_side / std::max(wide, high);
    width_ = std::max(least_side, static_cast<int>(std::ceil(wide * pixels_))) + 2 * margin;
    height_ = std::max(least_side, static_cast<int>(std::ceil(high * pixels_))) + margin + foot;
  }

  Image draw() const {
    const CairoSurface drawing = drawing_of(colours());
    const CairoContext context(cairo_create(drawing.get()), cairo_destroy);
    if (cairo_status(context.get()) != CAIRO_STATUS_SUCCESS) throw std::runtime_error("no memory for a drawing");
    cairo_select_font_face(context.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    for (const Light* light : plan_.luminaires) draw_luminaire(context.get(), *light);
    draw_numbers(context.get());
    draw_bar(context.get());
    Legend legend{scale_, {plan_.unit}};
    legend.values_above = std::ranges::any_of(plan_.values, [&](const auto& value) { return value && *value > scale_.high; });
    legend.paper = {paper, paper, paper};
    legend.ink = {20, 20, 20};
    return with_legend(image_of(drawing.get()), legend);
  }

 private:
  static ColourScale scale_of(std::span<const std::optional<double>> values) {
    std::vector<double> there;
    for (const auto& value : values)
      if (value) there.push_back(*value);
    return automatic_scale(std::move(there), false);
  }

  double x_of(double along_u) const { return margin + (along_u - room_.raster.left) * pixels_; }
  double y_of(double along_v) const { return height_ - foot - (along_v - room_.raster.bottom) * pixels_; }
  double u_at(int x) const { return room_.raster.left + (x + 0.5 - margin) / pixels_; }
  double v_at(int y) const { return room_.raster.bottom + (height_ - foot - y - 0.5) / pixels_; }

  /// Returns the number of the band between two curves in which the value at a pixel lies; nothing outside of the inner cells.
  std::optional<std::size_t> band_at(std::span<const double> curves, int x, int y) const {
    if (room_.cell_at(u_at(x), v_at(y)) != Room::Cell::inner) return std::nullopt;
    const auto value = field_.at(u_at(x), v_at(y));
    if (!value) return std::nullopt;
    return static_cast<std::size_t>(std::ranges::upper_bound(curves, *value) - curves.begin());
  }

  Image colours() const {
    const std::vector<double> curves = ticks(scale_, most_curves);
    Image image{width_, height_, {}};
    image.rgb.reserve(3 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        const auto band = band_at(curves, x, y), right = band_at(curves, x + 1, y), below = band_at(curves, x, y + 1);
        const bool is_curve = band && ((right && *right != *band) || (below && *below != *band));
        const auto colour = is_curve ? std::array<std::uint8_t, 3>{20, 20, 20} : colour_at(x, y);
        image.rgb.insert(image.rgb.end(), colour.begin(), colour.end());
      }
    return image;
  }

  std::array<std::uint8_t, 3> colour_at(int x, int y) const {
    const Room::Cell cell = room_.cell_at(u_at(x), v_at(y));
    if (cell == Room::Cell::elsewhere) return {paper, paper, paper};
    const auto value = cell == Room::Cell::inner ? field_.at(u_at(x), v_at(y)) : std::nullopt;
    if (!value) return {border_grey, border_grey, border_grey};
    const Rgb colour = colour_map(scale_.position(*value));
    return {srgb_byte(colour.r), srgb_byte(colour.g), srgb_byte(colour.b)};
  }

  /// Writes text about a place, dark on a light ground.
  static void write(cairo_t* context, double x, double y, double size, const std::string& text) {
    cairo_set_font_size(context, size);
    cairo_text_extents_t extents;
    cairo_text_extents(context, text.c_str(), &extents);
    const double left = x - extents.width / 2 - extents.x_bearing, base = y - extents.height / 2 - extents.y_bearing;
    cairo_move_to(context, left, base);
    cairo_text_path(context, text.c_str());
    cairo_set_source_rgba(context, 1, 1, 1, 0.85);
    cairo_set_line_width(context, 3);
    cairo_stroke_preserve(context);
    cairo_set_source_rgb(context, 0.05, 0.05, 0.05);
    cairo_fill(context);
  }

  void draw_numbers(cairo_t* context) const {
    const double room_for_text = std::min(plan_.grid.spacing_u / 2.6, plan_.grid.spacing_v / 1.3) * pixels_;
    const double size = std::min(15.0, room_for_text);
    constexpr double readable = 7;
    if (size < readable) return;
    for (std::size_t n = 0; n < plan_.grid.points.size(); ++n)
      if (plan_.values[n])
        write(context, x_of(plan_.grid.points[n].along_u), y_of(plan_.grid.points[n].along_v), size,
              number_text(*plan_.values[n]));
  }

  void draw_luminaire(cairo_t* context, const Light& light) const {
    const auto to = [&](Vec3 place, bool first) {
      const double x = x_of(dot(place, room_.frame.u)), y = y_of(dot(place, room_.frame.v));
      first ? cairo_move_to(context, x, y) : cairo_line_to(context, x, y);
    };
    bool has_outline = false;
    if (light.kind == LightKind::luminaire)
      for (const OpeningFace& face : faces_of_opening(light)) {
        if (std::abs(dot(face.normal, room_.frame.up)) < 0.1) continue;
        has_outline = true;
        constexpr int corners = 32;
        for (int n = 0; n < corners; ++n)
          to(face.is_round ? on_ellipse(face, n, corners) : on_rectangle(face, n, corners), n == 0);
        cairo_close_path(context);
      }
    if (!has_outline) {
      const double x = x_of(dot(light.position, room_.frame.u)), y = y_of(dot(light.position, room_.frame.v));
      cairo_move_to(context, x - 7, y), cairo_line_to(context, x + 7, y);
      cairo_move_to(context, x, y - 7), cairo_line_to(context, x, y + 7);
    }
    cairo_set_source_rgb(context, 0.85, 0.1, 0.1);
    cairo_set_line_width(context, 1.5);
    cairo_stroke(context);
  }

  static Vec3 on_ellipse(const OpeningFace& face, int n, int corners) {
    const double angle = 2 * std::numbers::pi * n / corners;
    return face.centre + std::cos(angle) * face.half_u + std::sin(angle) * face.half_v;
  }
  static Vec3 on_rectangle(const OpeningFace& face, int n, int corners) {
    const int side = 4 * n / corners;
    const double u = side == 0 || side == 3 ? -1 : 1, v = side < 2 ? -1 : 1;
    return face.centre + u * face.half_u + v * face.half_v;
  }

  void draw_bar(cairo_t* context) const {
    const double metres = RoundNumber::at_most(std::max(1e-3, 0.25 * room_.raster.columns * room_.raster.cell_u)).value();
    const double left = margin, right = margin + metres * pixels_, y = height_ - foot + 18;
    cairo_set_source_rgb(context, 0.1, 0.1, 0.1);
    cairo_set_line_width(context, 2);
    cairo_move_to(context, left, y - 4), cairo_line_to(context, left, y), cairo_line_to(context, right, y),
        cairo_line_to(context, right, y - 4);
    cairo_stroke(context);
    write(context, (left + right) / 2, y + 13, 13, short_text(metres) + " m");
  }

  const IsoluxPlan& plan_;
  const Room& room_;
  const GridField field_;
  const ColourScale scale_;
  double pixels_ = 1;  ///< per metre
  int width_ = 0, height_ = 0;
};

}  // namespace

GridField::GridField(const Room& room, const WorkGrid& grid, std::span<const std::optional<double>> values)
    : grid_(grid),
      first_u_(room.left + grid.spacing_u / 2),
      first_v_(room.bottom + grid.spacing_v / 2),
      values_(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows)) {
  for (std::size_t n = 0; n < grid.points.size(); ++n)
    values_[static_cast<std::size_t>(grid.points[n].row * grid.columns + grid.points[n].column)] = values[n];
}

std::optional<double> GridField::at(double along_u, double along_v) const {
  const double column = std::clamp((along_u - first_u_) / grid_.spacing_u, 0.0, grid_.columns - 1.0),
               row = std::clamp((along_v - first_v_) / grid_.spacing_v, 0.0, grid_.rows - 1.0);
  const int c = std::min(static_cast<int>(column), std::max(0, grid_.columns - 2)),
            r = std::min(static_cast<int>(row), std::max(0, grid_.rows - 2));
  double sum = 0, weights = 0;
  for (int dr = 0; dr <= 1; ++dr)
    for (int dc = 0; dc <= 1; ++dc) {
      if (c + dc >= grid_.columns || r + dr >= grid_.rows) continue;
      const auto& value = values_[static_cast<std::size_t>((r + dr) * grid_.columns + c + dc)];
      const double weight = (1 - std::abs(column - c - dc)) * (1 - std::abs(row - r - dr));
      if (!value || !(weight > 0)) continue;
      sum += weight * *value;
      weights += weight;
    }
  if (!(weights > 0)) return std::nullopt;
  return sum / weights;
}

Image draw_isolux(const IsoluxPlan& plan) { return Plan(plan).draw(); }

}  // namespace alvor
