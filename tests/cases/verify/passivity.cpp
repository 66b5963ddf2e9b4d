// SPDX-License-Identifier: MIT
#include "servo/safety/passivity/bounds.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

void passivityBounds(const Case& c, Check& check) {
  const Json& in = c.input;
  if (c.expect.contains("c_n")) {
    const auto window = passivity::windowCoefficient(in["n"].get<int>());
    check.near("c_n", window.value, c.expect["c_n"], number(c.tol["abs"]));
    check.near("theta", window.theta, c.expect["theta"], number(c.tol["theta_abs"]));
    return;
  }
  const double stiffness = passivity::maxStiffness(number(in["b"]), number(in["B"]), in["n"].get<int>(),
                                                   in["delay"].get<int>(), number(in["T"]));
  check.relative("K_max", stiffness, c.expect["K_max"], number(c.tol["rel"]));
}

}  // namespace
HAPTICD_VERIFY(passivity, passivityBounds)
}  // namespace hapticd::verify
