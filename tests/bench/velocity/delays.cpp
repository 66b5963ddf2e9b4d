// SPDX-License-Identifier: MIT
#include "delays.hpp"

#include <cmath>
#include <complex>

#include "response.hpp"

namespace hapticd::velocity_bench {
namespace {

/// Sum of -1/p over the poles of a low pass: its delay at frequency 0 over its cut-off frequency [rad/s].
double delayOfPoles(const std::vector<std::complex<double>>& poles) {
  std::complex<double> sum = 0;
  for (const std::complex<double>& p : poles) sum -= 1.0 / p;
  return sum.real();
}

/// Bilinear transform with the cut-off kept: low frequencies are stretched by the warp. Half a sample for the
/// difference.
double digital(double delay_times_cutoff, double cutoff, double rate) {
  const double warped = 2 * rate * std::tan(M_PI * cutoff / rate);
  return delay_times_cutoff / warped + 0.5 / rate;
}

/// The taps that stay: as many on either side of the point half a sample ago.
std::vector<int> middle(int taps) {
  std::vector<int> kept;
  for (int i = 0; i < taps; ++i) kept.push_back(1 - taps / 2 + i);
  return kept;
}

}  // namespace

double windowCutoff(int n, double rate) {
  double low = 0, high = 1;  // of sin(x)/x with x = pi f n T: half way to its first zero is far enough
  for (int i = 0; i < 80; ++i) {
    const double x = M_PI * (low + high) / 2;
    (std::sin(x) / x > M_SQRT1_2 ? low : high) = (low + high) / 2;
  }
  return low * rate / n;
}

double butterworthDelay(int order, double cutoff, double rate) {
  std::vector<std::complex<double>> poles;
  for (int k = 0; k < order; ++k) poles.push_back(std::polar(1.0, M_PI / 2 + M_PI * (2 * k + 1) / (2.0 * order)));
  return digital(delayOfPoles(poles), cutoff, rate);
}

double chebyshevDelay(int order, double ripple_db, double cutoff, double rate) {
  const double epsilon = std::sqrt(std::pow(10, ripple_db / 10) - 1), a = std::asinh(1 / epsilon) / order;
  // -3 dB against frequency 0, where a differentiator must be right; there even orders are a ripple below their top.
  const double fall = order % 2 == 0 ? std::sqrt(2 + 1 / (epsilon * epsilon)) : 1 / epsilon;
  const double half_power = std::cosh(std::acosh(fall) / order);
  std::vector<std::complex<double>> poles;
  for (int k = 0; k < order; ++k) {
    const double angle = M_PI * (2 * k + 1) / (2.0 * order);
    poles.emplace_back(-std::sinh(a) * std::sin(angle) / half_power, std::cosh(a) * std::cos(angle) / half_power);
  }
  return digital(delayOfPoles(poles), cutoff, rate);
}

double truncatedGain(int taps) {
  double gain = 0;
  for (const int n : middle(taps)) gain -= (n - 0.5) * idealTap(n);
  return std::abs(gain);
}

double truncatedNoise(int taps, double rate) {
  double squares = 0;
  for (const int n : middle(taps)) squares += idealTap(n) * idealTap(n);
  return std::sqrt(squares) * rate / truncatedGain(taps);
}

}  // namespace hapticd::velocity_bench
