// SPDX-License-Identifier: MIT
/// Truth for spline tests: the definitions (Cox-de Boor, quotient rule) in exact rational arithmetic.
#pragma once
#include <Eigen/Core>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <vector>

#include "kernels/spline/curve_data.hpp"
#include "kernels/spline/surface_data.hpp"

namespace hapticd::spline::exact {

using Rational = boost::multiprecision::cpp_rational;

/// N_{i,p} and derivatives 0..2 of all i, at u (Piegl & Tiller 2.5 and 2.7; 0/0 is 0).
inline std::array<std::vector<Rational>, 3> basis(const std::vector<double>& knots, int degree, double u) {
  const std::size_t last = knots.size() - 1;
  const Rational t(u);
  std::vector<Rational> U(knots.begin(), knots.end());
  const auto p = static_cast<std::size_t>(degree);
  std::size_t span = p;  // right-continuous; the end of the domain belongs to the last span
  for (std::size_t k = p; k + p < last; ++k) {
    if (U[k] < U[k + 1] && U[k] <= t) span = k;
  }
  std::array<std::vector<Rational>, 3> N;
  for (auto& row : N) row.assign(last, Rational(0));
  N[0][span] = 1;
  for (std::size_t j = 1; j <= p; ++j) {
    for (std::size_t i = 0; i + j < last; ++i) {  // ascending: entry i + 1 is still of degree j - 1
      const Rational a = U[i + j] - U[i], b = U[i + j + 1] - U[i + 1];
      for (std::size_t k = 2; k < 3; --k) {
        const Rational slope =
            k == 0 ? Rational(0)
                   : Rational((a == 0 ? Rational(0) : N[k - 1][i] / a) - (b == 0 ? Rational(0) : N[k - 1][i + 1] / b));
        const Rational value = (a == 0 ? Rational(0) : Rational((t - U[i]) / a * N[k][i])) +
                               (b == 0 ? Rational(0) : Rational((U[i + j + 1] - t) / b * N[k][i + 1]));
        N[k][i] = k == 0 ? value : Rational(static_cast<int>(j) * slope);
      }
    }
  }
  return N;
}

using Vector = std::array<Rational, 4>;  // x, y, z times weight, and the weight

inline Eigen::Vector3d rounded(const Vector& v) {
  return {v[0].convert_to<double>(), v[1].convert_to<double>(), v[2].convert_to<double>()};
}

/// S, Su, Sv, Suu, Suv, Svv, each rounded once.
inline std::array<Eigen::Vector3d, 6> surface(const SurfaceData& data, double u, double v) {
  const auto Nu = basis(data.knots[0], data.degree[0], u), Nv = basis(data.knots[1], data.degree[1], v);
  constexpr std::array<std::array<std::size_t, 2>, 6> kOrders = {{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};
  const auto count_u = static_cast<std::size_t>(data.count(0)), count_v = static_cast<std::size_t>(data.count(1));
  std::array<Vector, 6> A{};
  for (std::size_t i = 0; i < count_u; ++i) {
    for (std::size_t j = 0; j < count_v; ++j) {
      const auto& point = data.points[i * count_v + j];
      const Rational w = data.weights.empty() ? Rational(1) : Rational(data.weights[i * count_v + j]);
      for (std::size_t k = 0; k < 6; ++k) {
        const Rational share = Nu[kOrders[k][0]][i] * Nv[kOrders[k][1]][j] * w;
        if (share == 0) continue;
        for (int c = 0; c < 3; ++c) A[k][static_cast<std::size_t>(c)] += share * Rational(point[c]);
        A[k][3] += share;
      }
    }
  }
  const auto W = [&](std::size_t k) { return A[k][3]; };
  std::array<Vector, 6> S{};
  for (std::size_t c = 0; c < 3; ++c) {
    S[0][c] = A[0][c] / W(0);
    S[1][c] = (A[1][c] - W(1) * S[0][c]) / W(0);
    S[2][c] = (A[2][c] - W(2) * S[0][c]) / W(0);
    S[3][c] = (A[3][c] - 2 * W(1) * S[1][c] - W(3) * S[0][c]) / W(0);
    S[4][c] = (A[4][c] - W(1) * S[2][c] - W(2) * S[1][c] - W(4) * S[0][c]) / W(0);
    S[5][c] = (A[5][c] - 2 * W(2) * S[2][c] - W(5) * S[0][c]) / W(0);
  }
  std::array<Eigen::Vector3d, 6> result;
  for (std::size_t k = 0; k < 6; ++k) result[k] = rounded(S[k]);
  return result;
}

/// C, C1, C2, each rounded once: a curve is a surface that is linear and constant along v.
inline std::array<Eigen::Vector3d, 3> curve(const CurveData& data, double u) {
  SurfaceData ruled;
  ruled.degree = {data.degree, 1};
  ruled.knots = {data.knots, {0, 0, 1, 1}};
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    for (int j = 0; j < 2; ++j) {
      ruled.points.push_back(data.points[i]);
      if (!data.weights.empty()) ruled.weights.push_back(data.weights[i]);
    }
  }
  const auto S = surface(ruled, u, 0);
  return {S[0], S[1], S[3]};
}

}  // namespace hapticd::spline::exact
