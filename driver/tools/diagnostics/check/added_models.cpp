// SPDX-License-Identifier: MIT
#include "diagnostics/check/added_models.hpp"

#include <cstddef>

#include "diagnostics/scene/unfelt_models.hpp"
#include "diagnostics/scene/value_plausibility.hpp"
#include "document/problem.hpp"
#include "tune/stability.hpp"

namespace hapticd::diagnostics {

std::vector<std::string> warningsOfAddedModels(const servo::Runner& runner, const scene::Scene& models,
                                               const std::vector<double>& stiffness, host::Catalog& catalog) {
  scene::Scene scene = models;
  scene.servo = runner.scene().servo;
  scene.devices = runner.scene().devices;
  document::Problems all = farModels(scene);
  document::append(all, softModels(models, catalog));
  document::append(all, tune::fastPaths(models));
  document::append(all, implausibleValues(scene, {}, catalog));
  for (size_t i = 0; i < runner.arms().size(); ++i)
    document::append(all, tune::unstableSettings(scene, scene.devices[i], runner.arms()[i]->info(), stiffness));
  std::vector<std::string> texts;
  for (const document::Problem& one : all) texts.push_back(one.text());
  return texts;
}

}  // namespace hapticd::diagnostics
