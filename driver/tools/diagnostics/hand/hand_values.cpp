// SPDX-License-Identifier: MIT
#include "diagnostics/hand/hand_values.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace hapticd::diagnostics {
namespace {

constexpr double kThousandth = 1e-3;

class HandValues {
 public:
  HandValues(const scene::Scene& scene, const scene::Device& device, const UnreadKeys& unread,
             document::Problems& warnings)
      : scene_(scene), device_(device), unread_(unread), warnings_(warnings) {}

  /// Returns the value that the files give; nullptr if they give none, or a wrong one.
  const scene::Value* read(const char* id) const { return unread_.has(id) ? nullptr : givenIn(device_.parameters, id); }

  bool isAbove(const char* id, double most) const {
    const scene::Value* value = read(id);
    return value != nullptr && value->number > most;
  }

  void tell(const char* id, const std::string& what) const {
    const HandKey key = keyOfHand(scene_, device_, {id});
    document::report(warnings_, key.place, key.id, what);
  }

  /// Warns of a force of the hand's tremor or wander that was probably given in mN.
  void checkTremor(const char* id, double most, double usual) const {
    if (!isAbove(id, most)) return;
    const double force = read(id)->number;
    tell(id, fmt::format("{0:g} N shakes the hand far more than a person's hand (about {1:g} N); the value must be in "
                         "N: {0:g} mN is {2:g} N",
                         force, usual, force * kThousandth));
  }

 private:
  const scene::Scene& scene_;
  const scene::Device& device_;
  const UnreadKeys& unread_;
  document::Problems& warnings_;
};

bool isRepeated(const HandScript& hand) {
  return hand.kind == HandScript::Kind::kStroke || hand.kind == HandScript::Kind::kCircle || hand.presses();
}

/// Returns true if the script beside this key is known. Of a misspelt script it is the one that was probably meant; if
/// there is none, the script of another file may be given.
bool knowsScriptOf(const scene::Device& device, const char* id, const UnreadKeys& unread) {
  const scene::Value *script = givenIn(device.parameters, "hand.script"), *value = givenIn(device.parameters, id);
  if (!unread.has("hand.script")) return true;
  return script != nullptr && value != nullptr && script->place.file == value->place.file;
}

void checkHandRate(const HandValues& values, const HandScript& hand) {
  constexpr double kOften = 12;  // [Hz] nobody moves a hand so often
  if (!isRepeated(hand) || !values.isAbove("hand.rate", kOften)) return;
  values.tell("hand.rate", fmt::format("{0:g} times a second is more often than a person moves a hand; the value must "
                                       "be in Hz: {0:g} times a minute is {1:.3g} Hz",
                                       hand.rate, hand.rate / 60));
}

void checkSpring(const HandValues& values, const HandScript& hand) {
  constexpr double kSoft = 5, kAway = 0.01;  // [N/m]; [m]
  const scene::Value* spring = values.read("hand.stiffness");
  const bool led = hand.kind == HandScript::Kind::kGuided;
  const bool moves = isRepeated(hand) || hand.kind == HandScript::Kind::kPath || led;
  if (!moves || spring == nullptr || spring->number >= kSoft) return;
  values.tell("hand.stiffness",
              fmt::format("{0:g} N/m is so soft that the hand does not follow {3}: {1:g} mm away from it, the "
                          "spring pulls with {2:g} N; the value must be in N/m (1 N/mm is 1000 N/m)",
                          spring->number, kAway / kThousandth, spring->number * kAway,
                          led ? "the program that leads it" : "its script"));
}

const char* wordOf(HandScript::Kind script);

/// Warns of a hand whose script moves it, but with no depth or not even once.
void checkStill(const HandValues& values, const HandScript& hand) {
  if (!isRepeated(hand)) return;
  const bool turns = hand.kind == HandScript::Kind::kCircle || hand.kind == HandScript::Kind::kStroke;
  const char* id = hand.rate == 0 ? "hand.rate" : turns || hand.rise > 0 ? nullptr : "hand.rise";
  if (id == nullptr || values.read(id) == nullptr) return;
  values.tell(id, fmt::format("with 0 {} the hand rests and never does its script, {}; "
                              "expected a number above 0, or script: hold",
                              hand.rate == 0 ? "Hz" : "m", wordOf(hand.kind)));
}

const char* wordOf(HandScript::Kind script) {
  constexpr const char* kWords[] = {"hold", "stroke", "press", "tap", "circle", "path", "none", "guided"};
  return kWords[static_cast<size_t>(script)];
}

/// Returns the keys of the hand that its script does not use.
std::vector<const char*> idleKeys(HandScript::Kind script) {
  using Script = HandScript::Kind;
  switch (script) {
    case Script::kHold:
      return {"hand.axis", "hand.sweep", "hand.rise", "hand.rate"};
    case Script::kPress:
    case Script::kTap:
      return {"hand.axis", "hand.sweep"};
    case Script::kCircle:
      return {"hand.sweep", "hand.rise"};
    case Script::kPath:
      return {"hand.center", "hand.normal", "hand.axis",     "hand.radius", "hand.sweep",
              "hand.rise",   "hand.rate",   "hand.approach", "hand.lead_in"};
    case Script::kGuided:
      return {"hand.axis", "hand.sweep", "hand.rise", "hand.rate", "hand.approach", "hand.lead_in"};
    case Script::kNone:
      return {"hand.mass",     "hand.stiffness", "hand.damping", "hand.center", "hand.normal",
              "hand.axis",     "hand.radius",    "hand.sweep",   "hand.rise",   "hand.rate",
              "hand.approach", "hand.lead_in",   "hand.tremor",  "hand.wander"};
    default:
      return {};
  }
}

/// Warns of keys that the script of the hand does not use. A scene may replace the script of its device file, so keys
/// of the device file are judged only by a script of the same file.
void checkIdleKeys(const scene::Device& device, const HandScript& hand, const UnreadKeys& unread,
                   document::Problems& warnings) {
  const scene::Value* script = givenIn(device.parameters, "hand.script");
  if (script == nullptr || unread.has("hand.script")) return;
  for (const char* id : idleKeys(hand.kind)) {
    const scene::Value* value = givenIn(device.parameters, id);
    const bool in_device = value != nullptr && value->place.file == device.file.string();
    if (value == nullptr || unread.has(id) || (in_device && script->place.file != value->place.file)) continue;
    document::report(warnings, value->place, id,
                     fmt::format("has no effect with hand.script: {}; remove this key, or choose another script",
                                 wordOf(hand.kind)));
  }
}

}  // namespace

void checkHandValues(const scene::Scene& scene, const scene::Device& device, const HandScript& hand,
                     const UnreadKeys& unread, document::Problems& warnings) {
  constexpr double kHeavy = 5, kLong = 10;                   // [kg] heavier than a forearm; [s] that check watches
  constexpr double kTremor = 1, kWander = 2;                 // [N]
  constexpr double kUsualTremor = 0.05, kUsualWander = 0.1;  // [N] the module's defaults
  checkIdleKeys(device, hand, unread, warnings);
  if (hand.kind == HandScript::Kind::kNone) return;
  const HandValues values(scene, device, unread, warnings);
  if (values.isAbove("hand.mass", kHeavy))
    values.tell("hand.mass",
                fmt::format("{0:g} kg is more than a hand and its forearm weigh at the tip (about 0.2 to "
                            "1 kg); the value must be in kg: {0:g} g is {1:g} kg",
                            values.read("hand.mass")->number, values.read("hand.mass")->number * kThousandth));
  values.checkTremor("hand.tremor", kTremor, kUsualTremor);
  values.checkTremor("hand.wander", kWander, kUsualWander);
  if (hand.moves() && values.isAbove("hand.lead_in", kLong))
    values.tell("hand.lead_in", fmt::format("{0:g} s pass before the script begins; "
                                            "the value must be in s: {0:g} ms is {1:g} s",
                                            hand.lead_in, hand.lead_in * kThousandth));
  if (knowsScriptOf(device, "hand.rate", unread)) checkHandRate(values, hand);
  if (knowsScriptOf(device, "hand.stiffness", unread)) checkSpring(values, hand);
  if (knowsScriptOf(device, "hand.rise", unread)) checkStill(values, hand);
}

}  // namespace hapticd::diagnostics
