// SPDX-License-Identifier: MIT
#include <complex>
#include <numbers>

#include "servo/velocity/estimator.hpp"
#include "verify.hpp"

namespace hapticd::verify {
namespace {

using Complex = std::complex<long double>;

/// What the production estimator answers to one sample of 1 among zeros, from the tick of that sample on.
std::vector<double> impulseResponse(int n, double rate) {
  auto estimator = velocity::make("window", n, rate);
  std::vector<double> taps;
  for (int i = -n - 1; i <= n; ++i) {
    const double v = estimator.update({i == 0 ? 1.0 : 0.0, 0, 0}, i == -n - 1 ? 0 : 1 / rate).x();
    if (i >= 0) taps.push_back(v);
  }
  return taps;
}

/// Sum of taps k^power exp(-j k angle).
Complex transform(const std::vector<double>& taps, long double angle, int power = 0) {
  Complex sum = 0;
  for (size_t k = 0; k < taps.size(); ++k)
    sum += static_cast<long double>(taps[k] * std::pow(static_cast<double>(k), power)) *
           std::polar(1.0L, -angle * static_cast<long double>(k));
  return sum;
}

void response(const Case& c, Check& check) {
  const double rate = number(c.input["fs"]), tolerance = number(c.tol["rel"]);
  const std::vector<double> taps = impulseResponse(c.input["n"].get<int>(), rate);
  const long double angle = 2 * std::numbers::pi_v<long double> * truth(c.input["f"]) / truth(c.input["fs"]);
  const Complex H = transform(taps, angle);
  double noise = 0;
  for (const double tap : taps) noise += tap * tap;
  check.relative("gain", static_cast<double>(std::abs(H)), c.expect["gain"], tolerance);
  const long double turned = std::arg(H * std::polar(1.0L, -truth(c.expect["phase_rad"])));
  check.near("phase", static_cast<double>(turned), 0.0, tolerance);
  check.relative("delay", static_cast<double>((transform(taps, angle, 1) / H).real()) / rate, c.expect["delay_s"],
                 tolerance);
  check.relative("noise", std::sqrt(noise), c.expect["white_noise_gain"], tolerance);
}

/// Tap n of the ideal differentiator that is as late as the production window of one sample (Eq. 6): the inverse
/// transform of that window's response, freed of what it loses toward half the sampling rate, by Gauss's rule.
double idealTap(const std::vector<double>& window, int n) {
  constexpr int kPanels = 64;
  constexpr long double kNode[] = {0.18343464249564980494L, 0.52553240991632898582L, 0.79666647741362673959L,
                                   0.96028985649753623168L};
  constexpr long double kWeight[] = {0.36268378337836198297L, 0.31370664587788728734L, 0.22238103445337447054L,
                                     0.10122853629037625915L};
  const long double pi = std::numbers::pi_v<long double>, half = pi / (2 * kPanels);
  long double sum = 0;
  for (int panel = 0; panel < kPanels; ++panel)
    for (int node = 0; node < 8; ++node) {
      const long double side = node % 2 == 0 ? -1 : 1;
      const long double w = half * (2 * panel + 1 + side * kNode[node / 2]);
      const Complex ideal = transform(window, w) * ((w / 2) / std::sin(w / 2));
      sum += half * kWeight[node / 2] * (ideal * std::polar(1.0L, w * n)).real() / pi;
    }
  return static_cast<double>(sum);
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
  const std::vector<double> window = impulseResponse(1, 1);
  for (size_t i = 0; i < c.expect["h"].size(); ++i)
    check.relative("h", idealTap(window, c.input["n"][i].get<int>()), c.expect["h"][i], number(c.tol["rel"]));
}

}  // namespace
HAPTICD_VERIFY(velocity_filter, velocityFilter)
}  // namespace hapticd::verify
