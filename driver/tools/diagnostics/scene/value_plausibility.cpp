// SPDX-License-Identifier: MIT
#include "diagnostics/scene/value_plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "diagnostics/reading/given_values.hpp"
#include "diagnostics/reading/key_place.hpp"
#include "diagnostics/reading/model_of_key.hpp"
#include "diagnostics/scene/given_model.hpp"

namespace hapticd::diagnostics {
namespace {

/// Returns a pose as text, to the micrometre. Equal poses have equal texts.
std::string poseText(const scene::Pose& pose) {
  constexpr double kSame = 1e-6;
  std::string text;
  const Eigen::Quaterniond& q = pose.orientation;
  const double sign = q.w() < 0 ? -1 : 1;
  for (const double x : {pose.position.x(), pose.position.y(), pose.position.z(), sign * q.w(), sign * q.x(),
                         sign * q.y(), sign * q.z()})
    text += fmt::format("\n{:.0f}", x / kSame + 0.0);
  return text;
}

/// Returns a text that is equal for two models in the same place: it has their file, its part that is shown, the side
/// that is felt, and the pose, or each pose on their path.
std::string placeText(const scene::Model& model) {
  const scene::Value* geometry = givenIn(model.parameters, "geometry");
  if (geometry == nullptr || (model.kinematic && model.path.empty())) return "";
  std::string text = model.plugin + "\n" + geometry->text;
  for (const char* id : {"instance", "without"})
    if (const scene::Value* named = givenIn(model.parameters, id)) text += fmt::format("\n{} {}", id, named->text);
  if (const scene::Value* sides = givenIn(model.parameters, "sides")) text += fmt::format("\nsides {}", sides->number);
  if (!model.kinematic) return text + poseText(model.pose);
  for (const scene::PathPoint& point : model.path) text += fmt::format("\nt {}", point.t) + poseText(point.pose);
  return text;
}

}  // namespace

std::vector<std::vector<size_t>> modelsInOnePlace(const scene::Scene& scene) {
  std::map<std::string, std::vector<size_t>> by_place;
  for (size_t i = 0; i < scene.models.size(); ++i)
    if (const std::string text = placeText(scene.models[i]); !text.empty() && scene.models[i].enabled)
      by_place[text].push_back(i);
  std::vector<std::vector<size_t>> groups;
  for (auto& [text, models] : by_place)
    if (models.size() > 1) groups.push_back(std::move(models));
  return groups;
}

namespace {

void reportModelsInOnePlace(const scene::Scene& scene, const std::vector<bool>& placed, document::Problems& warnings) {
  for (std::vector<size_t> group : modelsInOnePlace(scene)) {
    std::erase_if(group, [&placed](size_t model) { return !placed[model]; });
    for (size_t i = 1; i < group.size(); ++i) {
      const scene::Model &first = scene.models[group[0]], &model = scene.models[group[i]];
      document::report(
          warnings, model.place, fmt::format("models[{}].{}", group[i], model.kinematic ? "path" : "pose"),
          fmt::format(
              "{} and {} (line {}) have the same geometry in the same place, so a hand feels the sum of both; give "
              "one of them another {}",
              model.name, first.name, first.place.line, model.kinematic ? "path" : "pose"));
    }
  }
}

/// Warns of a pose beside a path, because the path alone says where the model is.
void reportIdlePoses(const scene::Scene& scene, const std::vector<bool>& placed, document::Problems& warnings) {
  for (size_t i = 0; i < scene.models.size(); ++i) {
    const scene::Model& model = scene.models[i];
    const std::string pose = poseText(model.pose);
    if (!placed[i] || model.path.empty() || pose == poseText({}) || pose == poseText(model.path.front().pose)) continue;
    reportInModel(warnings, scene, i, "pose",
                  fmt::format("has no effect: the path of {} gives its poses in the world; remove the pose, and add it "
                              "to the rows of the path",
                              model.name));
  }
}

/// Returns true if it is known where the model is, and which of its surfaces are felt.
bool isPlaced(const UnreadModel& unread) {
  if (unread.any || unread.hasOwn("pose") || unread.hasOwn("path") || unread.hasOwn("motion")) return false;
  return std::none_of(unread.ids.begin(), unread.ids.end(), [](const std::string& id) {
    return id == "geometry" || id == "instance" || id == "without" || id == "sides" || id == "motion";
  });
}

}  // namespace

document::Problems implausibleValues(const scene::Scene& scene, const ModelBoxes& boxes, host::Catalog& catalog,
                                     const UnreadKeys& unread) {
  document::Problems warnings, of_values;
  const std::optional<Eigen::AlignedBox3d> unknown;
  std::vector<bool> placed(scene.models.size());
  for (size_t i = 0; i < scene.models.size(); ++i) {
    const auto plugin = catalog.shape(scene.models[i].plugin);
    if (!plugin) continue;
    UnreadModel of_model = unread.ofModel(i, **plugin);
    placed[i] = isPlaced(of_model);
    const GivenModel given(scene, i, i < boxes.size() ? boxes[i] : unknown, **plugin, of_values, std::move(of_model));
    checkQuantities(given);
    checkBody(given);
    checkIdleParameters(given);
  }
  reportModelsInOnePlace(scene, placed, warnings);
  reportIdlePoses(scene, placed, warnings);
  document::append(warnings, std::move(of_values));
  return warnings;
}

std::vector<bool> strayModels(const scene::Scene& scene, const ModelBoxes& boxes, host::Catalog& catalog) {
  constexpr std::string_view kParameters = ".parameters.";
  std::vector<bool> strays(scene.models.size());
  for (const document::Problem& one : implausibleValues(scene, boxes, catalog)) {
    const size_t at = one.key.find(kParameters);
    const auto model = modelOf(one.key);
    if (!model || *model >= strays.size() || at == std::string::npos) continue;
    const std::string id = one.key.substr(at + kParameters.size());
    for (const char* moves : {"mass", "inertia", "center", "tether", "velocity", "spin", "drag", "joint", "pivot",
                              "limits", "rest", "length", "angle", "rate"})
      if (id == moves) strays[*model] = true;
  }
  return strays;
}

}  // namespace hapticd::diagnostics
