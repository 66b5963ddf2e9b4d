// SPDX-License-Identifier: MIT
#include "diagnostics/hand/hand_script.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "document/csv.hpp"
#include "host/class_params.hpp"
#include "host/device_instance.hpp"

namespace hapticd::diagnostics {
namespace {

using Kind = HandScript::Kind;

constexpr double kRiseRatio = 0.31;  ///< ratio of the speed of a stroke's rise to rise times rate, as in the module
constexpr size_t kMaxPathBytes = size_t{1} << 30;

/// Returns a number as the files give it, or the module's default.
double numberOf(const scene::Device& device, const hdv_class& module, const char* id) {
  if (const scene::Value* value = givenIn(device.parameters, id)) return value->number;
  const auto index = host::paramIndexOf(module, id);
  return index ? host::paramAt(module, *index).def : 0;
}

void readPath(const scene::Device& device, HandScript& hand) {
  const scene::Value* path = givenIn(device.parameters, "hand.path");
  if (path == nullptr) return;
  const auto table =  // wrong rows are reported by the module, which opens the file
      document::readSoundRows(path->text, kMaxPathBytes, {{"t,x,y,z", "t,x,y,z,qw,qx,qy,qz"}, true, true});
  if (!table || table->rows() == 0) return;
  hand.path_end = table->row(table->rows() - 1)[0];
  hand.path_times = {path->text, table->lines[std::min<size_t>(1, table->rows() - 1)], 1};
  for (size_t i = 0; i < table->rows(); ++i)
    for (size_t axis = 1; axis <= 3; ++axis)
      hand.path_widest = std::max(hand.path_widest, std::abs(table->row(i)[axis]));
  for (size_t i = 1; i < table->rows(); ++i) {
    const double *from = table->row(i - 1), *to = table->row(i);
    const double way = std::hypot(to[1] - from[1], to[2] - from[2], to[3] - from[3]), speed = way / (to[0] - from[0]);
    hand.path_length += way;
    if (speed <= hand.path_speed * (1 + 1e-9)) continue;  // of equal speeds, the first counts
    hand.path_speed = speed;
    hand.path_fastest_at = from[0];
  }
}

}  // namespace

HandKey keyOfHand(const scene::Scene& scene, const scene::Device& device, std::initializer_list<const char*> ids) {
  const bool named = !device.chosen_by_default;
  for (const bool in_scene : {true, false})
    for (const char* id : ids)
      if (const scene::Value* value = givenIn(device.parameters, id);
          value != nullptr && (!in_scene || value->place.file == scene.file.string()))
        return {named || in_scene ? value->place : document::Place{scene.file.string(), 1, 1}, id};
  return {named ? device.place : document::Place{scene.file.string(), 1, 1}, "hand"};
}

double HandScript::speed() const {
  const double turn = 2 * std::numbers::pi * rate;
  switch (kind) {
    case Kind::kStroke:
      return turn * std::hypot(radius * sweep, kRiseRatio * rise);
    case Kind::kCircle:
      return turn * radius;
    case Kind::kPress:
      return turn * rise / 2;
    case Kind::kTap:
      return turn * rise;
    case Kind::kPath:
      return path_speed;
    default:
      return 0;
  }
}

double HandScript::cycleTime() const {
  constexpr double kRest = 1;  // [s] how long a hand that holds still is watched
  if (kind == Kind::kPath) return path_end;
  const bool repeats =
      rate > 0 && (kind == Kind::kStroke || kind == Kind::kCircle || kind == Kind::kPress || kind == Kind::kTap);
  return lead_in + (repeats ? 1 / rate : kRest);
}

std::optional<HandScript> handScriptOf(const scene::Device& device) {
  if (device.module != "simulated") return std::nullopt;
  const auto instance = host::DeviceInstance::create(device, nullptr);
  if (!instance) return std::nullopt;
  const hdv_class& module = (*instance)->description();
  const auto number = [&](const char* id) { return numberOf(device, module, id); };
  HandScript hand;
  hand.kind = static_cast<Kind>(number("hand.script"));
  hand.radius = number("hand.radius"), hand.sweep = number("hand.sweep");
  hand.rise = number("hand.rise"), hand.rate = number("hand.rate"), hand.lead_in = number("hand.lead_in"),
  hand.approach = number("hand.approach");
  if (const scene::Value* center = givenIn(device.parameters, "hand.center"); center && center->numbers.size() == 3)
    hand.center = Eigen::Map<const Eigen::Vector3d>(center->numbers.data());
  if (const scene::Value* normal = givenIn(device.parameters, "hand.normal"); normal && normal->numbers.size() == 3)
    hand.normal = Eigen::Map<const Eigen::Vector3d>(normal->numbers.data());
  if (hand.kind == Kind::kPath) readPath(device, hand);
  return hand;
}

}  // namespace hapticd::diagnostics
