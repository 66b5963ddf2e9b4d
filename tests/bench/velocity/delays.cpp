// SPDX-License-Identifier: MIT
#include "delays.hpp"

#include <cmath>
#include <complex>

#include "response.hpp"

namespace hapticd::velocity_bench {
namespace {

/// Returns the delay [s] at frequency 0 of a low pass whose poles are given for a cut-off of 1 rad/s: the sum of -1/p
/// over the poles p. For another cut-off frequency, divide by it.
double delayOfPoles(const std::vector<std::complex<double>>& poles) {
  std::complex<double> sum = 0;
  for (const std::complex<double>& p : poles) sum -= 1.0 / p;
  return sum.real();
}

/// Returns the delay [s] of the digital filter behind a difference of two samples. The bilinear transform is prewarped
/// so that it keeps the cut-off, which stretches low frequencies. The difference adds half a sample.
double digital(double delay_times_cutoff, double cutoff, double rate) {
  const double warped = 2 * rate * std::tan(M_PI * cutoff / rate);
  return delay_times_cutoff / warped + 0.5 / rate;
}

/// Returns the indices of the taps that remain: equally many on each side of the time half a sample ago.
std::vector<int> middle(int taps) {
  std::vector<int> kept;
  for (int i = 0; i < taps; ++i) kept.push_back(1 - taps / 2 + i);
  return kept;
}

}  // namespace

double windowCutoff(int n, double rate) {
  double low = 0, high = 1;  // brackets x / pi for the gain sin(x) / x = 1 / sqrt(2), with x = pi f n T
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
  // The cut-off is 3 dB below the gain at frequency 0, because a differentiator must be exact there. At frequency 0 the
  // gain of even orders is one ripple below its maximum.
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
