// SPDX-License-Identifier: MIT
#include "diagnostics/hand_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "diagnostics/hand_values.hpp"
#include "document/csv.hpp"
#include "document/reader.hpp"
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
  const auto table =  // wrong rows are told by the module, which opens the file
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
    hand.path_way += way;
    if (speed <= hand.path_speed * (1 + 1e-9)) continue;  // of equal speeds, the first counts
    hand.path_speed = speed;
    hand.path_fastest_at = from[0];
  }
}

/// Returns words for the motion that makes a script so fast.
std::string wayOf(const HandScript& hand) {
  switch (hand.kind) {
    case Kind::kStroke:
      return fmt::format("{:.4g} rad to either side at {:.4g} m, {:.4g} times a second", hand.sweep, hand.radius,
                         hand.rate);
    case Kind::kCircle:
      return fmt::format("round at {:.4g} m, {:.4g} times a second", hand.radius, hand.rate);
    case Kind::kPath:
      return fmt::format("from t = {:.4g} s", hand.path_fastest_at);
    default:
      return fmt::format("presses {:.4g} m deep, {:.4g} times a second", hand.rise, hand.rate);
  }
}

void checkSpeed(const scene::Scene& scene, const scene::Device& device, const HandScript& hand,
                document::Problems& warnings) {
  const double speed = hand.speed();
  if (speed <= kFastestHand * 1.001) return;
  const bool follows = hand.kind == Kind::kPath;
  const HandKey key = follows ? keyOfHand(scene, device, {"hand.path"})
                              : keyOfHand(scene, device, {"hand.rate", "hand.rise", "hand.sweep", "hand.radius"});
  document::report(warnings, key.place, key.id,
                   fmt::format("the hand of {} moves at up to {:.3g} m/s ({}), which is faster than a human hand; "
                               "expected at most {:g} m/s: {}",
                               device.name, speed, wayOf(hand), kFastestHand,
                               follows ? "times in s, places in m" : "hand.rate in Hz, lengths in m, angles in rad"));
}

/// Warns of a path file whose times seem to be in ms, because its hand is extremely slow.
void checkSlowMotion(const scene::Device& device, const HandScript& hand, document::Problems& warnings) {
  constexpr double kCrawl = 2e-3, kLong = 10, kFar = 5e-3;  // [m/s]; [s]; [m] a shorter path counts as rest
  constexpr double kWidest = 2;                             // [m] places farther away must be in mm
  const double unit = hand.path_widest > kWidest ? 1e-3 : 1, way = unit * hand.path_way;
  if (hand.kind != Kind::kPath || hand.path_end < kLong || way < kFar) return;
  if (unit * hand.path_speed > 10 * kCrawl || way > kCrawl * hand.path_end) return;
  document::report(
      warnings, hand.path_times, "t",
      fmt::format("the hand of {} takes {:.4g} s for {:.3g} mm ({:.2g} mm/s); times must be in s (1 ms is 0.001)",
                  device.name, hand.path_end, way * 1e3, way / hand.path_end * 1e3));
}

/// Warns of a sweep that was meant in degrees. Returns true if it was, so that the speed needs no warning of its own.
bool checkSweep(const scene::Device& device, const HandScript& hand, const UnreadKeys& unread,
                document::Problems& warnings) {
  const scene::Value* sweep = givenIn(device.parameters, "hand.sweep");
  const bool may_stroke = hand.kind == Kind::kStroke || unread.has("hand.script");
  if (!may_stroke || unread.has("hand.sweep") || sweep == nullptr || hand.sweep <= std::numbers::pi * 1.001)
    return false;
  const std::string meant = hand.sweep <= 360 ? fmt::format(" ({:.4g} degrees is {:.4g} rad)", hand.sweep,
                                                            hand.sweep * std::numbers::pi / 180)
                                              : "";
  document::report(warnings, sweep->place, "hand.sweep",
                   fmt::format("{:.4g} rad to either side is more than half a turn, so the hand of {} goes all the way "
                               "round the model; expected at most {:.4g} rad{}",
                               hand.sweep, device.name, std::numbers::pi, meant));
  return true;
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

document::Problems fastHands(const scene::Scene& scene, const UnreadKeys& unread) {
  document::Problems warnings;
  for (const scene::Device& device : scene.devices) {
    const auto hand = handScriptOf(device);
    if (!hand) continue;
    const bool wide = checkSweep(device, *hand, unread, warnings);
    const size_t before = warnings.size();
    if (wide && hand->sweep <= 360 && !unread.has("hand")) {  // judged with the sweep that was probably meant
      HandScript mended = *hand;
      mended.sweep *= std::numbers::pi / 180;
      checkSpeed(scene, device, mended, warnings);
    } else if (!wide && !unread.has("hand")) {
      checkSpeed(scene, device, *hand, warnings);
      checkSlowMotion(device, *hand, warnings);
    }
    const bool fast = warnings.size() > before;
    document::Problems of_values;
    checkHandValues(scene, device, *hand, unread, of_values);
    for (document::Problem& one : of_values)  // a hand that is too fast has a warning already
      if (!fast || one.key != "hand.rate") warnings.push_back(std::move(one));
  }
  return warnings;
}

}  // namespace hapticd::diagnostics
