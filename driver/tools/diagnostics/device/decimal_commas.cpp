// SPDX-License-Identifier: MIT
#include "diagnostics/device/decimal_commas.hpp"

#include <vector>

#include "diagnostics/device/device_trial.hpp"
#include "document/correction.hpp"

namespace hapticd::diagnostics {
namespace {

constexpr size_t kLongest = 16;  ///< a longer list is no list of one arm's lengths or torques

/// Returns true if the module does not complain about the parameter when it has these numbers.
bool takes(scene::Device device, const std::string& id, const std::vector<double>& numbers) {
  for (scene::Value& value : device.parameters)
    if (value.id == id) value.numbers = numbers;
  return tryModule(device).error.find(id + ": ") == std::string::npos;
}

/// Returns the numbers of a list in which each zero before a number is the whole part of that number.
std::vector<double> withPoints(const std::vector<double>& numbers) {
  std::vector<double> joined;
  for (size_t i = 0; i < numbers.size(); ++i) {
    double part = i + 1 < numbers.size() && numbers[i] == 0 ? numbers[i + 1] : 0;
    const bool decimal = part >= 1;
    while (part >= 1) part /= 10;
    joined.push_back(decimal ? part : numbers[i]);
    i += decimal ? 1 : 0;
  }
  return joined;
}

}  // namespace

std::string adviceOnCommas(const scene::Device& device, const std::string& id, const document::Node& list) {
  const std::string advice = document::suggestDecimals(list, 1);
  const scene::Value* given = givenIn(device.parameters, id);
  if (advice.empty() || given == nullptr || given->numbers.size() > kLongest) return "";
  const std::vector<double> meant = withPoints(given->numbers);
  if (takes(device, id, meant)) return advice;
  for (size_t count = 1; count < given->numbers.size(); ++count) {
    std::vector<double> shorter = meant;
    shorter.resize(count, meant.back());
    if (takes(device, id, shorter)) return advice;
  }
  return "";
}

}  // namespace hapticd::diagnostics
