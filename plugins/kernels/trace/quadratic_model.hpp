// SPDX-License-Identifier: MIT
/// The quadratic model of the squared distance from a probe to a surface, for Newton's method.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/spline/surface.hpp"

namespace hapticd::trace {

/// Least value of 1 + depth * curvature at which a pure Newton step is made. This value is the second derivative of
/// half the squared distance, per metre of surface. Below it the probe is near a centre of curvature, and the step
/// would be mostly rounding error.
inline constexpr double kMinCurvature = 1e-3;
/// If one tangent is shorter than this share of the other, or they are this close to parallel, they do not span a
/// plane: the point is a pole or a cusp.
inline constexpr double kFlatTangent = 1e-12;

/// Quadratic model of f = |S - p|^2 / 2 about an evaluated point.
struct QuadraticModel {
  Eigen::Vector2d g;            ///< gradient
  Eigen::Matrix2d H;            ///< positive definite
  Eigen::Vector2d sided{0, 0};  ///< second derivatives of f along a side v = const, and u = const; 0 if not reliable
  /// True if the true Hessian has a negative eigenvalue, so that this point is not a foot even if the gradient is 0.
  bool saddle = false;
  Eigen::Vector2d escape{0, 0};  ///< direction of negative curvature, unit length in space
};

/// The orthonormal frame of the tangent plane: (Su Sv) = Q L^T with L lower triangular (Gram-Schmidt). In this frame
/// curvatures are per metre, and an ill-scaled or sheared parameterisation does no harm.
struct TangentFrame {
  double l11, l21, l22;
};

inline TangentFrame tangentFrame(const Eigen::Vector3d& Su, const Eigen::Vector3d& Sv) noexcept {
  TangentFrame L;
  L.l11 = Su.norm();
  const Eigen::Vector3d e1 = L.l11 > 0 ? Eigen::Vector3d(Su / L.l11) : Eigen::Vector3d::Zero();
  L.l21 = e1.dot(Sv);
  L.l22 = (Sv - L.l21 * e1).norm();
  return L;
}

/// Returns the Hessian of the first-order model (Gauss-Newton), with enough damping to be regular where tangents
/// vanish.
inline Eigen::Matrix2d damped(const spline::SurfacePoint& E) noexcept {
  Eigen::Matrix2d G;
  G << E.Su.squaredNorm(), E.Su.dot(E.Sv), 0, E.Sv.squaredNorm();
  G(1, 0) = G(0, 1);
  const double floor = 1e-10 * std::max(G(0, 0), G(1, 1)) + std::numeric_limits<double>::min();
  G(0, 0) += floor;
  G(1, 1) += floor;
  return G;
}

/// Returns the second derivative of f along a side, or 0 if it is not reliable. It may be reliable even if the Hessian
/// over both parameters is not.
inline double sidedCurvature(const Eigen::Vector3d& S1, double bend) noexcept {
  const double first_order = S1.squaredNorm();
  return first_order + bend > kMinCurvature * first_order ? first_order + bend : 0;
}

inline QuadraticModel modelOf(const spline::SurfacePoint& E, const Eigen::Vector3d& r) noexcept {
  QuadraticModel m;
  m.g = {r.dot(E.Su), r.dot(E.Sv)};
  m.sided = {sidedCurvature(E.Su, r.dot(E.Suu)), sidedCurvature(E.Sv, r.dot(E.Svv))};
  const TangentFrame L = tangentFrame(E.Su, E.Sv);
  const double longer = std::max(L.l11, E.Sv.norm());
  if (!(L.l11 > kFlatTangent * longer) || !(L.l22 > kFlatTangent * longer)) {
    m.H = damped(E);
    return m;
  }
  Eigen::Matrix2d B;
  B << r.dot(E.Suu), r.dot(E.Suv), 0, r.dot(E.Svv);
  // A = I + L^-1 B L^-T is the Hessian per metre of surface. Its eigenvalues are 1 + depth * principal curvature.
  const double i11 = 1 / L.l11, i22 = 1 / L.l22, i21 = -L.l21 * i11 * i22;
  const double b11 = B(0, 0), b12 = B(0, 1), b22 = B(1, 1);
  const double a11 = 1 + i11 * i11 * b11;
  const double a12 = i11 * (i21 * b11 + i22 * b12);
  const double a22 = 1 + i21 * i21 * b11 + 2 * i21 * i22 * b12 + i22 * i22 * b22;
  const double mean = 0.5 * (a11 + a22), half = std::sqrt(0.25 * (a11 - a22) * (a11 - a22) + a12 * a12);
  if (mean - half > kMinCurvature) {
    m.H << L.l11 * L.l11 + b11, L.l11 * L.l21 + b12, 0, L.l21 * L.l21 + L.l22 * L.l22 + b22;
    m.H(1, 0) = m.H(0, 1);
    return m;
  }
  // Replace A by |A|, with the same axes and positive curvatures, so that the step descends and leaves a saddle or a
  // maximum.
  constexpr double kFloor = 0.05;
  const double angle = 0.5 * std::atan2(2 * a12, a11 - a22);
  const Eigen::Vector2d major(std::cos(angle), std::sin(angle)), minor(-major.y(), major.x());
  const double low = std::max(std::abs(mean - half), kFloor), high = std::max(std::abs(mean + half), kFloor);
  const Eigen::Matrix2d A = high * major * major.transpose() + low * minor * minor.transpose();
  Eigen::Matrix2d lower;
  lower << L.l11, 0, L.l21, L.l22;
  m.H = lower * A * lower.transpose();
  m.saddle = mean - half < -kMinCurvature;
  m.escape = {i11 * minor.x() + i21 * minor.y(), i22 * minor.y()};
  return m;
}

}  // namespace hapticd::trace
