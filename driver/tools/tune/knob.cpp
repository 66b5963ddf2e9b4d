// SPDX-License-Identifier: MIT
#include "tune/knob.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "hapticd/abi.h"

namespace hapticd::tune {
namespace {

/// Returns the default multiplied by powers of ten, from 0.001 to 1000, as far as they lie in the range, and the
/// scene's own value.
std::vector<double> ladderOfReal(const host::ParamInfo& param, double present) {
  std::set<double> values{present};
  for (int decade = -3; decade <= 3; ++decade) {
    const double value = param.def * std::pow(10, decade);
    if (value >= param.min && value <= param.max && value > 0) values.insert(value);
  }
  return {values.begin(), values.end()};
}

/// Returns every whole number of a short range; for a long range, the default times 1/4, 1/2, 1, 2 and 4.
std::vector<double> ladderOfInteger(const host::ParamInfo& param, double present) {
  constexpr double kFew = 5;
  std::set<double> values{present, param.def};
  if (param.max - param.min < kFew) {
    for (double value = param.min; value <= param.max; ++value) values.insert(value);
  } else {
    for (double factor : {0.25, 0.5, 2.0, 4.0})
      values.insert(std::clamp(std::round(param.def * factor), param.min, param.max));
  }
  return {values.begin(), values.end()};
}

/// Returns lists of equal counts, from 1 to the default, such as "[4, 4]".
std::vector<double> ladderOfList(const host::ParamInfo& param, double present) {
  std::set<double> values{present};
  const double most = param.def_text ? std::strtod(param.def_text->c_str() + 1, nullptr) : present;
  for (double value = std::max(1.0, param.min); value <= most; ++value) values.insert(value);
  return {values.begin(), values.end()};
}

size_t indexOf(const std::vector<double>& numbers, double value) {
  const auto it = std::find(numbers.begin(), numbers.end(), value);
  return it == numbers.end() ? 0 : static_cast<size_t>(it - numbers.begin());
}

Knob knobOf(const host::ClassInfo& info, uint32_t index, double present) {
  const host::ParamInfo& param = info.params[index];
  Knob knob{info.name, param.id, param.unit, index, param.kind, {}, {}, 0, 0};
  if (param.kind == HSP_REAL) {
    knob.numbers = ladderOfReal(param, present);
    knob.finest = 0;
  } else if (param.kind == HSP_ARRAY) {
    knob.numbers = ladderOfList(param, present);
    knob.finest = knob.numbers.size() - 1;
  } else if (param.kind == HSP_INT) {
    knob.numbers = ladderOfInteger(param, present);
    knob.finest = knob.numbers.size() - 1;
  } else {
    const size_t count = param.kind == HSP_BOOL ? 2 : param.choices.size();
    for (size_t i = 0; i < count; ++i) knob.numbers.push_back(static_cast<double>(i));
    const bool added = param.kind == HSP_ENUM && param.choices == std::vector<std::string>{"off", "on"};
    knob.finest = indexOf(knob.numbers, added ? present : param.def);
  }
  for (const double number : knob.numbers)
    knob.values.push_back(param.kind == HSP_ENUM    ? param.choices[static_cast<size_t>(number)]
                          : param.kind == HSP_ARRAY ? fmt::format("[{0:g}, {0:g}]", number)
                          : param.kind == HSP_BOOL  ? (number != 0 ? "true" : "false")
                                                    : fmt::format("{:g}", number));
  knob.current = indexOf(knob.numbers, present);
  return knob;
}

void addPluginKnobs(const scene::Scene& scene, const host::ClassInfo& info, std::vector<Knob>& knobs) {
  for (uint32_t i = 0; i < info.params.size(); ++i) {
    const host::ParamInfo& param = info.params[i];
    const bool list = param.kind == HSP_ARRAY && param.min_count == 2 && param.max_count == 2;
    const bool tunable =
        list || param.kind == HSP_REAL || param.kind == HSP_INT || param.kind == HSP_BOOL || param.kind == HSP_ENUM;
    if ((param.flags & HSP_P_ACCURACY) == 0 || !tunable) continue;
    double present = list && param.def_text ? std::strtod(param.def_text->c_str() + 1, nullptr) : param.def;
    for (const scene::Model& model : scene.models) {
      if (model.plugin != info.name) continue;
      for (const scene::Value& value : model.parameters)
        if (value.index == i) present = value.numbers.empty() ? value.number : value.numbers.front();
      break;  // the first model represents all
    }
    Knob knob = knobOf(info, i, present);
    if (knob.numbers.size() > 1) knobs.push_back(std::move(knob));
  }
}

void applyPlugin(scene::Scene& scene, const Knob& knob, size_t value) {
  for (scene::Model& model : scene.models) {
    if (model.plugin != knob.plugin) continue;
    const auto it = std::find_if(model.parameters.begin(), model.parameters.end(),
                                 [&](const scene::Value& v) { return v.index == knob.index; });
    scene::Value& target = it != model.parameters.end() ? *it : model.parameters.emplace_back();
    target.id = knob.key;
    target.index = knob.index;
    target.kind = knob.kind;
    target.number = knob.numbers[value];
    if (knob.kind == HSP_ARRAY) target.numbers.assign(2, knob.numbers[value]);
  }
}

}  // namespace

std::vector<Knob> findKnobs(const scene::Scene& scene, host::Catalog& catalog) {
  std::vector<Knob> knobs;
  std::set<std::string> seen;
  for (const scene::Model& model : scene.models)
    if (seen.insert(model.plugin).second)
      if (auto info = catalog.shape(model.plugin)) addPluginKnobs(scene, **info, knobs);
  return knobs;
}

scene::Scene applied(scene::Scene scene, const std::vector<Knob>& knobs, const Choice& choice) {
  for (size_t i = 0; i < knobs.size(); ++i) applyPlugin(scene, knobs[i], choice[i]);
  return scene;
}

Choice currentOf(const std::vector<Knob>& knobs) {
  Choice choice;
  for (const Knob& knob : knobs) choice.push_back(knob.current);
  return choice;
}

Choice finestOf(const std::vector<Knob>& knobs) {
  Choice choice;
  for (const Knob& knob : knobs) choice.push_back(knob.finest);
  return choice;
}

std::string difference(const std::vector<Knob>& knobs, const Choice& choice, const Choice& from) {
  std::string text;
  for (size_t i = 0; i < knobs.size(); ++i)
    if (choice[i] != from[i]) text += (text.empty() ? "" : ", ") + knobs[i].name() + " " + knobs[i].values[choice[i]];
  return text;
}

}  // namespace hapticd::tune
