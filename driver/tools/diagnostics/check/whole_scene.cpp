// SPDX-License-Identifier: MIT
#include "diagnostics/check/whole_scene.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "base/shell_word.hpp"
#include "diagnostics/check/any_scene.hpp"
#include "diagnostics/device/device_trial.hpp"
#include "diagnostics/device/device_warnings.hpp"
#include "diagnostics/device/like_arms.hpp"
#include "diagnostics/device/slow_arm.hpp"
#include "diagnostics/hand/fast_hands.hpp"
#include "diagnostics/hand/hand_path_warnings.hpp"
#include "diagnostics/hand/hand_start.hpp"
#include "diagnostics/hand/hands_beside_problems.hpp"
#include "diagnostics/hand/pass_through.hpp"
#include "diagnostics/reading/model_of_key.hpp"
#include "diagnostics/scene/arm_bounds.hpp"
#include "diagnostics/scene/far_paths.hpp"
#include "diagnostics/scene/model_trial.hpp"
#include "diagnostics/scene/slow_paths.hpp"
#include "diagnostics/scene/unfelt_models.hpp"
#include "diagnostics/scene/velocity_warnings.hpp"
#include "world/arm_force.hpp"

namespace hapticd::diagnostics {
namespace {

/// Judges the hands of a scene. Models that their plugins refuse are left out, and those whose surfaces are doubtful.
document::Problems warningsOfHands(scene::Scene full, const ModelTrial& trial, host::Catalog& catalog,
                                   CheckResult& result) {
  std::vector<bool> refused(full.models.size()), curved(full.models.size());
  for (const document::Problem& one : result.problems)
    if (const auto model = modelOf(one.key); !model || *model >= refused.size())
      return fastHands(full);  // `run` refuses the hand, or an arm
  const std::vector<document::Problems> of_models = problemsOfModels(result.problems, refused.size());
  for (size_t i = 0; i < refused.size(); ++i) {
    curved[i] = !of_models[i].empty() && leaveOutCurves(full.models[i], i, of_models[i]);
    refused[i] = !of_models[i].empty() && !curved[i];
  }
  for (const document::Problem& one : trial.warnings)
    if (const auto model = modelOf(one.key); model && *model < refused.size() && isOfSurfaces(one))
      refused[*model] = true, curved[*model] = false;
  result.hands_moved = true;
  document::Problems warnings =
      warnOfHandsBesideProblems(full, trial.boxes, refused, std::vector<bool>(full.models.size(), true), catalog);
  dropOfCurves(curved, warnings);
  return warnings;
}

/// Returns true if the same key of the same file has a warning already.
bool tells(const document::Problems& told, const document::Problem& one) {
  return std::any_of(told.begin(), told.end(), [&one](const document::Problem& known) {
    return known.key == one.key && known.place.file == one.place.file && known.place.line == one.place.line;
  });
}

/// Adds the warnings that a check of the device files alone gives.
void warnOfDevices(const scene::Scene& full, host::Catalog& catalog, document::Problems& warnings) {
  for (const scene::Device& device : full.devices)
    for (const document::Problem& one : warnOfDevice(device.file, catalog))
      if (!tells(warnings, one) && one.key != "mount")  // the mount is checked with the scene instead
        warnings.push_back(one);
}

/// Returns warnings about settings that are allowed, but cannot be stable or are probably a mistake.
document::Problems warningsOfSettings(const scene::Scene& full, const ModelTrial& trial, host::Catalog& catalog) {
  document::Problems warnings = unstableContacts(full, trial.stiffness);
  document::append(warnings, lateVelocity(full, trial.needs_velocity));
  document::append(warnings, farModels(full));
  document::append(warnings, farPaths(full));
  document::append(warnings, slowPaths(full));
  document::append(warnings, softModels(full, catalog));
  document::append(warnings, idleBounds(full));
  document::append(warnings, unguardedPrograms(full));
  document::append(warnings, quarantinedModels(full));
  document::append(warnings, slowArms(full));
  document::append(warnings, likeArms(full));
  document::append(warnings, wideScales(full));
  warnOfSlips(full.file, warnings);
  return warnings;
}

/// Sets up the models, and adds the problems that `run` would find then and when it opens the arms.
ModelTrial addRefusals(const scene::Scene& full, double setup_seconds, CheckResult& result) {
  ModelTrial trial = tryModels(full, servo::maxForceOf(full), {}, setup_seconds);
  document::append(result.problems, trial.problems);
  document::append(result.problems, refusedArms(full, trial.needs_velocity));
  document::append(result.problems, refusedVelocity(full, trial.needs_velocity, result.warnings));
  return trial;
}

}  // namespace

document::Problems badModules(const scene::Scene& scene, host::Catalog& catalog) {
  document::Problems problems;
  for (const scene::Device& device : scene.devices) {
    const ModuleTrial trial = tryModule(device);
    if (trial.error.empty()) continue;
    const document::Problems placed = tryDevice(device.file, catalog);
    document::append(problems, placed);
    if (!placed.empty()) continue;  // the device file itself is wrong; otherwise the scene is
    const document::Place place =
        device.place.file.empty() ? document::Place{device.file.string()} : document::Place(device.place);
    document::report(problems, place, "device",
                     trial.error.substr(0, trial.error.find('\n')) + "; all of it: hapticd check " +
                         shellWord(device.file.string()));
  }
  return problems;
}

void judgeScene(const scene::Scene& scene, const CheckOptions& options, host::Catalog& catalog, CheckResult& result) {
  const scene::Scene full = withArm(scene, catalog);
  ModelTrial trial;
  if (!options.files_only) trial = addRefusals(full, options.setup_seconds, result);
  document::append(result.warnings, trial.warnings);
  document::Problems more = warningsOfSettings(full, trial, catalog);
  if (!options.files_only) {
    document::append(more, pressesThrough(full, trial.boxes, trial.moves));
    document::append(more, unreachableRows(full));
    document::append(more, warningsOfHands(full, trial, catalog, result));
  }
  if (!options.files_only || !options.device.empty()) warnOfDevices(full, catalog, more);
  document::append(result.warnings, std::move(more));
  addImplausible(full, trial.boxes, catalog, {}, result.warnings);
  for (const document::Problem& one : knocksOfDamping(full))  // last: a value in other units is told as such
    if (!tells(result.warnings, one)) result.warnings.push_back(one);
}

}  // namespace hapticd::diagnostics
