#pragma once
// Gauss and Gauss-Kronrod rules.

#include <algorithm>
#include <array>
#include <cmath>

namespace alvor {

/// A node of a quadrature on [0, 1].
struct GaussNode {
  double at, weight;
};

/// Gauss-Legendre rules on [0, 1].
inline constexpr std::array<GaussNode, 3> gauss_3{
    {{0.11270166537925831148, 5.0 / 18}, {0.5, 8.0 / 18}, {0.88729833462074168852, 5.0 / 18}}};
extern const std::array<GaussNode, 4> gauss_4;
extern const std::array<GaussNode, 6> gauss_6;
extern const std::array<GaussNode, 16> gauss_16;

/// A node of a quadrature on a triangle: the point corner0 + a (corner1 - corner0) + b (corner2 - corner0).
struct TriangleNode {
  double a, b, weight;
};

/// Radon's rule of degree 5 on a triangle (Stroud 1971, T2:5-1); the weights sum to 1.
inline constexpr std::array<TriangleNode, 7> radon_7{{{1.0 / 3, 1.0 / 3, 0.225},
                                                      {0.47014206410511508977, 0.47014206410511508977, 0.13239415278850618074},
                                                      {0.05971587178976982045, 0.47014206410511508977, 0.13239415278850618074},
                                                      {0.47014206410511508977, 0.05971587178976982045, 0.13239415278850618074},
                                                      {0.10128650732345633880, 0.10128650732345633880, 0.12593918054482715260},
                                                      {0.79742698535308732240, 0.10128650732345633880, 0.12593918054482715260},
                                                      {0.10128650732345633880, 0.79742698535308732240, 0.12593918054482715260}}};

/// An integral and its estimated error.
struct Quadrature {
  double value = 0, error = 0;
  double magnitude = 0;  ///< integral of the absolute value, to which rounding is relative
};

/// Kronrod's 15 nodes on [-1, 1] (positive half), with the embedded 7-point Gauss rule; QUADPACK (Piessens et al. 1983).
namespace kronrod {
inline constexpr std::array<double, 8> node{0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                                            0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                                            0.586087235467691130294144691693013, 0.405845151377397166906606412076961,
                                            0.207784955007898467600689403773245, 0.000000000000000000000000000000000};
inline constexpr std::array<double, 8> weight{0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                                              0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                                              0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                                              0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
inline constexpr std::array<double, 8> gauss_weight{
    0, 0.129484966168869693270611432679082, 0, 0.279705391489276667901467771423780,
    0, 0.381830050505118944950369775488975, 0, 0.417959183673469387755102040816327};
}  // namespace kronrod

/// Returns the integral of `f` over [a, b] by the 15-point rule. Its error is the difference from the 7-point rule.
template <class Function>
Quadrature kronrod_15(Function&& f, double a, double b) {
  const double middle = 0.5 * (a + b), half = 0.5 * (b - a), centre = f(middle);
  double sum = kronrod::weight[7] * centre, gauss = kronrod::gauss_weight[7] * centre, magnitude = std::abs(sum);
  for (int n = 0; n < 7; ++n) {
    const double low = f(middle - half * kronrod::node[n]), high = f(middle + half * kronrod::node[n]);
    sum += kronrod::weight[n] * (low + high);
    gauss += kronrod::gauss_weight[n] * (low + high);
    magnitude += kronrod::weight[n] * (std::abs(low) + std::abs(high));
  }
  return {half * sum, half * std::abs(sum - gauss), half * magnitude};
}

/// Returns the integral of `f` over [a, b] by adaptive 15-point rules. Intervals are halved until the error of each is within its
/// share of `tolerance` (absolute) or within rounding, or `depth` halvings were made.
template <class Function>
Quadrature integrate(Function&& f, double a, double b, double tolerance, int depth = 40) {
  constexpr double rounding = 1e-14;  // share of the integral of |f|, some 45 machine epsilons. Chosen; half and double give the
                                      // same solutions (docs/design/constants.md)
  const Quadrature whole = kronrod_15(f, a, b);
  if (whole.error <= std::max(tolerance, rounding * whole.magnitude) || depth == 0) return whole;
  const double middle = 0.5 * (a + b);
  const Quadrature low = integrate(f, a, middle, 0.5 * tolerance, depth - 1);
  const Quadrature high = integrate(f, middle, b, 0.5 * tolerance, depth - 1);
  return {low.value + high.value, low.error + high.error, low.magnitude + high.magnitude};
}

}  // namespace alvor
