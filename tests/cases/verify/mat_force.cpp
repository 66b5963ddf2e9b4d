// SPDX-License-Identifier: MIT
#include <Eigen/Core>

#include "kernels/medial/shear.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

/// A cap of radius R about the origin, pressed at its pole by x: the four neighbours lie at arc angle phi.
void matForce(const Case& c, Check& check) {
  const Json& in = c.input;
  const double r = number(in["R"]), phi = number(in["phi"]), k = number(in["k"]), keq = number(in["keq"]);
  const double x = number(in["x"]), side = r * std::sin(phi), up = r * std::cos(phi);
  const std::array<medial::ShearSpring, 4> springs{
      {{{side, 0, up}, keq}, {{-side, 0, up}, keq}, {{0, side, up}, keq}, {{0, -side, up}, keq}}};
  const Eigen::Vector3d force = medial::pressForce({0, 0, r - x}, {0, 0, r}, {0, 0, 1}, k, x, springs);
  const double tolerance = number(c.tol["rel"]);
  check.relative("F_out", force.z(), c.expect["F_out"], tolerance);
  check.near("sideways", std::hypot(force.x(), force.y()), 0.0, tolerance * std::fabs(force.z()));
}

}  // namespace
HAPTICD_VERIFY(mat_force, matForce)
}  // namespace hapticd::verify
