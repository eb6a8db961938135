#pragma once
// One value per band. Bands are three independent channels (linear RGB); no colour space is implied.

#include <algorithm>
#include <cmath>
#include <compare>
#include <concepts>

namespace alvor {

/// The unit of an Rgb whose type does not tell it: W/m2, or a factor, such as a reflectance, that any light may be multiplied by.
struct AnyUnit;

/// A value per band. Values of different `Unit` cannot be added, compared or converted to each other.
template <class T, class Unit = AnyUnit>
struct RgbOf {
  T r{}, g{}, b{};

  friend constexpr bool operator==(const RgbOf&, const RgbOf&) = default;

  constexpr RgbOf& operator+=(const RgbOf& o) {
    r += o.r;
    g += o.g;
    b += o.b;
    return *this;
  }
  constexpr RgbOf& operator-=(const RgbOf& o) {
    r -= o.r;
    g -= o.g;
    b -= o.b;
    return *this;
  }
  constexpr RgbOf& operator*=(T s) {
    r *= s;
    g *= s;
    b *= s;
    return *this;
  }

  friend constexpr RgbOf operator+(RgbOf a, const RgbOf& c) { return a += c; }
  friend constexpr RgbOf operator-(RgbOf a, const RgbOf& c) { return a -= c; }
  friend constexpr RgbOf operator*(RgbOf a, T s) { return a *= s; }
  friend constexpr RgbOf operator*(T s, RgbOf a) { return a *= s; }
  /// Multiplies band by band, as reflectance times irradiance.
  friend constexpr RgbOf operator*(const RgbOf& a, const RgbOf& c) requires std::same_as<Unit, AnyUnit> {
    return {a.r * c.r, a.g * c.g, a.b * c.b};
  }

  constexpr T sum() const { return r + g + b; }
  constexpr T mean() const { return sum() / T(3); }
  constexpr T max() const { return std::max({r, g, b}); }
  constexpr T min() const { return std::min({r, g, b}); }
  constexpr bool is_zero() const { return r == 0 && g == 0 && b == 0; }
  /// Returns whether the bands are equal to within a millionth. Files round colours that were grey.
  constexpr bool is_grey() const { return max() - min() <= T(1e-6) * max(); }
  bool is_finite() const { return std::isfinite(r) && std::isfinite(g) && std::isfinite(b); }
};

using Rgb = RgbOf<double>;  ///< double precision, for arithmetic
using RgbF = RgbOf<float>;  ///< float32, for storage and the wire

constexpr RgbF narrow(const Rgb& a) { return {static_cast<float>(a.r), static_cast<float>(a.g), static_cast<float>(a.b)}; }
constexpr Rgb widen(const RgbF& a) { return {a.r, a.g, a.b}; }

/// Returns the smaller value of each band.
template <class T, class Unit>
constexpr RgbOf<T, Unit> lower(const RgbOf<T, Unit>& a, const RgbOf<T, Unit>& b) {
  return {std::min(a.r, b.r), std::min(a.g, b.g), std::min(a.b, b.b)};
}
/// Returns the larger value of each band.
template <class T, class Unit>
constexpr RgbOf<T, Unit> upper(const RgbOf<T, Unit>& a, const RgbOf<T, Unit>& b) {
  return {std::max(a.r, b.r), std::max(a.g, b.g), std::max(a.b, b.b)};
}

template <class T, class Unit>
RgbOf<T, Unit> absolute(const RgbOf<T, Unit>& a) {
  return {std::abs(a.r), std::abs(a.g), std::abs(a.b)};
}

}  // namespace alvor
