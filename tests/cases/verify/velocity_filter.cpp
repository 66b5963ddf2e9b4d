// SPDX-License-Identifier: MIT
#include "servo/velocity/estimator.hpp"
#include "servo/velocity/response.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

void response(const Case& c, Check& check) {
  const auto got = velocity::windowResponse(c.input["n"].get<int>(), number(c.input["fs"]), number(c.input["f"]));
  const double tolerance = number(c.tol["rel"]);
  check.relative("gain", got.gain, c.expect["gain"], tolerance);
  check.relative("phase", got.phase, c.expect["phase_rad"], tolerance);
  check.relative("delay", got.delay, c.expect["delay_s"], tolerance);
  check.relative("noise", got.noise_gain, c.expect["white_noise_gain"], tolerance);
}

void sequence(const Case& c, Check& check) {
  const double period = number(c.input["T"]);
  auto estimator = velocity::make("window", number(c.input["n"]), 1 / period);
  const Json& expected = c.expect["v"];
  const bool absolute = c.tol.contains("abs");
  for (size_t i = 0; i < expected.size(); ++i) {
    const double got = estimator.update({number(c.input["y"][i]), 0, 0}, i == 0 ? 0 : period).x();
    if (expected[i].is_null()) continue;
    const std::string name = "v[" + std::to_string(i) + "]";
    if (absolute) {
      check.near(name, got, expected[i], number(c.tol["abs"]));
    } else {
      check.relative(name, got, expected[i], number(c.tol["rel"]));
    }
  }
}

void velocityFilter(const Case& c, Check& check) {
  if (c.input.contains("y")) return sequence(c, check);
  if (c.expect.contains("gain")) return response(c, check);
  for (size_t i = 0; i < c.expect["h"].size(); ++i)
    check.relative("h", velocity::idealTap(c.input["n"][i].get<int>()), c.expect["h"][i], number(c.tol["rel"]));
}

}  // namespace
HAPTICD_VERIFY(velocity_filter, velocityFilter)
}  // namespace hapticd::verify
