// SPDX-License-Identifier: MIT
#include "kernels/contact/wall.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

void wallModel(const Case& c, Check& check) {
  const Json& in = c.input;
  const contact::WallLaw law{number(in["k"]), number(in["lam"]), number(in["n"]), number(in["x0"])};
  const contact::WallForce wall = contact::wallForce(law, number(in["x"]), number(in["v"]));
  check.relative("F", wall.force, c.expect["F"], number(c.tol["rel"]));
  if (c.expect.contains("dFdx")) check.relative("dFdx", wall.stiffness, c.expect["dFdx"], number(c.tol["rel"]));
}

}  // namespace
HAPTICD_VERIFY(wall_model, wallModel)
}  // namespace hapticd::verify
