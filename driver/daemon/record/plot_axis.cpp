// SPDX-License-Identifier: MIT
#include "record/plot_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hapticd::record {

namespace {

constexpr double kLeast = 1e-300;  ///< used in place of values that a logarithmic axis cannot show

/// Returns the smallest step (1, 2 or 5 times a power of ten) that divides `span` into at most `most` pieces.
double stepOf(double span, size_t most) {
  const double raw = span / static_cast<double>(std::max<size_t>(most, 1));
  const double power = std::pow(10, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (raw <= factor * power * (1 + 1e-9)) return factor * power;
  return 10 * power;
}

std::vector<double> linearTicks(double low, double high, size_t most) {
  const double step = stepOf(high - low, most);
  std::vector<double> at;
  for (double k = std::ceil(low / step - 1e-6); k * step <= high + step * 1e-6; ++k)
    at.push_back(k == 0 ? 0 : k * step);
  return at;
}

/// Returns ticks at `factors` times every `stride`-th power of ten within the range.
std::vector<double> decadeTicks(const Axis& axis, const std::vector<double>& factors, int stride) {
  std::vector<double> at;
  const int first = static_cast<int>(std::floor(std::log10(axis.low) + 1e-9));
  const int last = static_cast<int>(std::ceil(std::log10(axis.high) - 1e-9));
  for (int decade = first; decade <= last; ++decade)
    for (const double factor : factors) {
      if (decade % stride != 0) continue;
      const double value = factor * std::pow(10, decade);
      if (value >= axis.low * (1 - 1e-9) && value <= axis.high * (1 + 1e-9)) at.push_back(value);
    }
  return at;
}

}  // namespace

double Axis::share(double value) const {
  if (!logarithmic) return (value - low) / (high - low);
  return std::log(std::max(value, kLeast) / low) / std::log(high / low);
}

double Axis::at(double share) const {
  return logarithmic ? low * std::pow(high / low, share) : low + (high - low) * share;
}

std::vector<double> Axis::ticks(size_t most) const {
  if (!logarithmic) return linearTicks(low, high, most);
  const std::vector<double> dense[] = {{1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9}, {1, 2, 3, 5, 7}, {1, 2, 5}, {1, 3}, {1}};
  for (const auto& factors : dense)
    if (const auto at = decadeTicks(*this, factors, 1); at.size() >= 2 && at.size() <= most) return at;
  for (int stride = 2; stride < 100; ++stride)
    if (const auto at = decadeTicks(*this, {1}, stride); at.size() >= 2 && at.size() <= most) return at;
  return linearTicks(low, high, most);  // the range is smaller than the distance between two such values
}

Axis axisOver(const std::string& label, double low, double high, bool logarithmic) {
  if (logarithmic) {
    low = std::max(low, kLeast);
    high = std::max(high, low);
    if (high < low * 1.5) low /= 1.5, high *= 1.5;
    return {label, low / std::pow(high / low, 0.04), high * std::pow(high / low, 0.04), true};
  }
  if (!(high > low)) high = low + std::max(std::abs(low) * 0.1, 1e-9);
  const double step = stepOf(high - low, 6);
  return {label, std::floor(low / step + 1e-9) * step, std::ceil(high / step - 1e-9) * step, false};
}

std::string tickText(double value) {
  if (std::abs(value) >= 1e6) return fmt::format("{:g}M", value / 1e6);
  if (std::abs(value) >= 1e4) return fmt::format("{:g}k", value / 1e3);
  return fmt::format("{:.6g}", value);
}

}  // namespace hapticd::record
