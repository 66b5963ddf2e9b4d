// SPDX-License-Identifier: MIT
#include "diagnostics/hand/hands_beside_problems.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>

#include "diagnostics/hand/hand_script.hpp"
#include "diagnostics/hand/hand_start.hpp"
#include "diagnostics/reading/key_place.hpp"
#include "diagnostics/reading/model_of_key.hpp"
#include "diagnostics/scene/value_plausibility.hpp"

namespace hapticd::diagnostics {
namespace {

constexpr std::string_view kModels = "models[";

/// Returns true if a hand may be meant for a model: it moves near it, or follows a path.
bool mayBeMeantFor(const scene::Scene& scene, const scene::Model& model) {
  constexpr double kNear = 0.15;  // [m] most models for a hand are smaller
  return std::any_of(scene.devices.begin(), scene.devices.end(), [&](const scene::Device& device) {
    const auto hand = handScriptOf(device);
    if (!hand || hand->kind == HandScript::Kind::kPath || model.kinematic) return true;
    const Eigen::Vector3d center = device.mount.position + device.mount.orientation * hand->center;
    return (center - model.pose.position).norm() < kNear + hand->radius + hand->rise;
  });
}

/// Gives a warning about a model of the smaller scene the index and the place that it has in the whole scene.
void renumber(const scene::Scene& scene, const std::vector<size_t>& indices, document::Problem& warning) {
  const auto index = modelOf(warning.key);
  if (!index || *index >= indices.size()) return;
  const size_t whole = indices[*index];
  warning.key = std::string(kModels) + std::to_string(whole) + warning.key.substr(warning.key.find(']'));
  if (warning.place.file != scene.file.string()) return;
  warning.place = placeOfKey(scene.file, warning.key).value_or(scene.models[whole].place);
}

}  // namespace

bool leaveOutCurves(scene::Model& model, size_t index, const document::Problems& problems) {
  constexpr std::string_view kCurves[] = {"detent",           "end_stiffness",    "damping", "friction_static",
                                          "friction_dynamic", "friction_viscous", "texture"};
  const std::string before = std::string(kModels) + std::to_string(index) + "].parameters.";
  for (const document::Problem& one : problems) {
    const std::string id = one.key.starts_with(before) ? one.key.substr(before.size()) : "";
    const std::string group = id.substr(0, id.find_first_of(".["));
    if (std::find(std::begin(kCurves), std::end(kCurves), group) == std::end(kCurves)) return false;
    std::erase_if(model.parameters, [&group](const scene::Value& value) { return value.id.starts_with(group); });
  }
  return true;
}

void dropOfCurves(const std::vector<bool>& curved, document::Problems& warnings) {
  if (std::find(curved.begin(), curved.end(), true) == curved.end()) return;
  std::erase_if(warnings, [&curved](const document::Problem& one) {
    const bool of_place = one.key.ends_with(".axis") || one.key.find("].pose") != std::string::npos;
    const auto model = modelOf(one.key);
    return (model && *model < curved.size() && curved[*model] && !of_place) ||
           one.what.find("cuts the force") != std::string::npos;
  });
}

bool isOfSurfaces(const document::Problem& warning) {
  const auto has = [&warning](const char* words) { return warning.what.find(words) != std::string::npos; };
  // A model in the wrong unit is placed all the same: where the hand is in it, and what it meets, are facts of their
  // own.
  if (has(" m large; a hand feels models")) return false;
  return has(".yaml:") && (has("].points") || has("there is a gap") || has("the outward normals of the two"));
}

document::Problems warnOfHandsBesideProblems(const scene::Scene& scene, const ModelBoxes& boxes,
                                             const std::vector<bool>& left_out, const std::vector<bool>& placed,
                                             host::Catalog& catalog, bool known) {
  scene::Scene rest = scene;
  rest.models.clear();
  ModelBoxes boxes_of_rest;
  std::vector<size_t> indices;
  bool all = true;
  for (size_t i = 0; i < scene.models.size(); ++i) {
    if (left_out[i]) {
      all = all && placed[i] && !mayBeMeantFor(scene, scene.models[i]);
      continue;
    }
    indices.push_back(i);
    rest.models.push_back(scene.models[i]);
    boxes_of_rest.push_back(i < boxes.size() ? boxes[i] : std::nullopt);
  }
  document::Problems warnings = warnOfHands(rest, strayModels(rest, boxes_of_rest, catalog), all, known);
  for (document::Problem& one : warnings) renumber(scene, indices, one);
  return warnings;
}

}  // namespace hapticd::diagnostics
