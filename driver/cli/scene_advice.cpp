// SPDX-License-Identifier: MIT
#include "cli/scene_advice.hpp"

#include <utility>

#include "cli/command.hpp"
#include "diagnostics/unusual_values.hpp"
#include "document/reader.hpp"
#include "tune/stability.hpp"

namespace hapticd::cli {

document::Problems farModels(const scene::Scene& scene) {
  constexpr double kFar = 10;  // [m]
  document::Problems warnings;
  for (size_t i = 0; i < scene.models.size(); ++i)
    if (const double away = scene.models[i].pose.position.norm(); away > kFar)
      document::report(
          warnings, scene.models[i].place, "models[" + std::to_string(i) + "].pose.position",
          document::numberText(away) + " m from the world's origin, where no arm reaches; the position must be in m");
  return warnings;
}

document::Problems softModels(const scene::Scene& scene) {
  constexpr double kUnfelt = 5;  // [N/m] 10 mm of depth give 0.05 N, less than the friction of most arms
  document::Problems warnings;
  for (size_t i = 0; i < scene.models.size(); ++i)
    for (const scene::Value& value : scene.models[i].parameters)
      if (value.id == "stiffness" && value.kind == HSP_REAL && value.number < kUnfelt)
        document::report(warnings, value.place, "models[" + std::to_string(i) + "].parameters.stiffness",
                         document::numberText(value.number) + " N/m cannot be felt: 1 mm gives " +
                             document::numberText(value.number * 1e-3) +
                             " N; the value must be in N/m (1 N/mm is 1000 N/m)");
  return warnings;
}

std::vector<std::string> adviceOnModels(const servo::Runner& runner, const scene::Scene& models,
                                        const std::vector<double>& stiffness) {
  document::Problems all = farModels(models);
  const auto add = [&all](document::Problems more) {
    for (document::Problem& one : more) all.push_back(std::move(one));
  };
  add(softModels(models));
  add(tune::fastPaths(models));
  scene::Scene scene = models;
  scene.servo = runner.scene().servo;
  add(diagnostics::unusualValues(scene, {}, catalog()));
  for (size_t i = 0; i < runner.arms().size(); ++i)
    add(tune::unstableSettings(scene, runner.scene().devices[i], runner.arms()[i]->info(), stiffness));
  std::vector<std::string> texts;
  for (const document::Problem& one : all) texts.push_back(one.text());
  return texts;
}

}  // namespace hapticd::cli
