// SPDX-License-Identifier: MIT
#include "diagnostics/hand/fast_hands.hpp"

#include <fmt/format.h>

#include <numbers>
#include <string>

#include "diagnostics/hand/hand_script.hpp"
#include "diagnostics/hand/hand_values.hpp"
#include "document/reader.hpp"

namespace hapticd::diagnostics {
namespace {

using Kind = HandScript::Kind;

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
  const double unit = hand.path_widest > kWidest ? 1e-3 : 1, way = unit * hand.path_length;
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

document::Problems fastHands(const scene::Scene& scene, const UnreadKeys& unread) {
  document::Problems warnings;
  for (const scene::Device& device : scene.devices) {
    const auto hand = handScriptOf(device);
    if (!hand) continue;
    const bool wide = checkSweep(device, *hand, unread, warnings);
    const size_t before = warnings.size();
    if (wide && hand->sweep <= 360 && !unread.has("hand")) {  // judged with the sweep that was probably meant
      HandScript meant = *hand;
      meant.sweep *= std::numbers::pi / 180;
      checkSpeed(scene, device, meant, warnings);
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
