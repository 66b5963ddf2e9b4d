// SPDX-License-Identifier: MIT
#include "diagnostics/hand/radius_advice.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "diagnostics/hand/hand_walk.hpp"
#include "host/class_params.hpp"
#include "host/device_instance.hpp"
#include "world/arm_force.hpp"
#include "world/world.hpp"

namespace hapticd::diagnostics {
namespace {

constexpr double kLeastRadius = 1e-3, kMostRadius = 0.2;  ///< [m] few arms let a hand move farther from its centre
constexpr double kMostOfTrials = 2;                       ///< [s] of processor time for all trials of one advice

/// Returns the scene with this radius of a hand; nothing if its module has no such parameter.
std::optional<scene::Scene> withRadius(const scene::Scene& scene, uint32_t device, double radius) {
  constexpr const char* kId = "hand.radius";
  scene::Scene changed = scene;
  std::vector<scene::Value>& values = changed.devices[device].parameters;
  const auto given = std::find_if(values.begin(), values.end(), [](const auto& value) { return value.id == kId; });
  if (given != values.end()) {
    given->number = radius;
    return changed;
  }
  const auto instance = host::DeviceInstance::create(scene.devices[device], nullptr);
  const auto index = instance ? host::paramIndexOf((*instance)->description(), kId) : std::nullopt;
  if (!index) return std::nullopt;
  scene::Value value;
  value.id = kId;
  value.index = *index;
  value.kind = HSP_REAL;
  value.number = radius;
  values.push_back(value);
  return changed;
}

bool touches(const scene::Scene& scene, uint32_t device) {
  const servo::WorldOptions options{.rate = scene.servo.rate,
                                    .probe_count = static_cast<uint32_t>(scene.devices.size()),
                                    .max_force = servo::maxForceOf(scene)};
  const auto world = servo::World::build(scene, options, [](int, const std::string&, const std::string&) {});
  const auto walk = world ? walkHands(scene, **world) : std::nullopt;
  return walk && !walk->late && walk->arms[device].touched && !walk->arms[device].began_inside;
}

}  // namespace

std::optional<double> radiusThatTouches(const scene::Scene& scene, uint32_t device, const std::vector<double>& radii) {
  constexpr double kRound = 1e4;  // [1/m] steps of 0.1 mm
  const std::clock_t begun = std::clock();
  for (const double wanted : radii) {
    const double radius = std::round(wanted * kRound) / kRound;
    if (!(radius >= kLeastRadius && radius <= kMostRadius)) continue;
    if (static_cast<double>(std::clock() - begun) > kMostOfTrials * CLOCKS_PER_SEC) break;
    const auto changed = withRadius(scene, device, radius);
    if (changed && touches(*changed, device)) return radius;
  }
  return std::nullopt;
}

std::optional<double> radiusOfFarHand(const scene::Scene& scene, uint32_t device, const HandScript& hand, double away,
                                      bool inwards) {
  std::vector<double> radii;
  if (away > 0) {
    for (const double deep : {3e-3, 5e-3, 10e-3, 20e-3})  // [m] how much deeper than the surface the hand aims
      radii.push_back(inwards ? hand.radius - away - deep : hand.radius + away + deep);
  } else {
    for (const double factor : {0.8, 1.25, 0.5, 2.0, 4.0}) radii.push_back(hand.radius * factor);
  }
  return radiusThatTouches(scene, device, radii);
}

std::optional<double> radiusOfInnerHand(const scene::Scene& scene, uint32_t device, const HandScript& hand,
                                        double depth) {
  // The hand starts by hand.approach farther out than it aims. It should start outside, but aim a few mm inside.
  std::vector<double> radii;
  for (const double deep : {4e-3, 2e-3, 8e-3, 15e-3})
    if (deep < hand.approach) radii.push_back(hand.radius + depth + hand.approach - deep);
  radii.push_back(hand.radius + depth + 1e-3);
  return radiusThatTouches(scene, device, radii);
}

}  // namespace hapticd::diagnostics
