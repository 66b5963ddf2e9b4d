// SPDX-License-Identifier: MIT
#include "diagnostics/check/draft_scene.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "diagnostics/check/any_scene.hpp"
#include "diagnostics/check/draft_models.hpp"
#include "diagnostics/device/device_trial.hpp"
#include "diagnostics/device/slow_arm.hpp"
#include "diagnostics/hand/fast_hands.hpp"
#include "diagnostics/hand/hand_path_warnings.hpp"
#include "diagnostics/hand/hand_start.hpp"
#include "diagnostics/hand/pass_through.hpp"
#include "diagnostics/reading/key_place.hpp"
#include "diagnostics/reading/unread_keys.hpp"
#include "diagnostics/scene/arm_bounds.hpp"
#include "diagnostics/scene/far_paths.hpp"
#include "diagnostics/scene/model_trial.hpp"
#include "diagnostics/scene/slow_paths.hpp"
#include "diagnostics/scene/unfelt_models.hpp"
#include "diagnostics/scene/velocity_warnings.hpp"
#include "tune/stability.hpp"
#include "world/arm_force.hpp"

namespace hapticd::diagnostics {
namespace {

/// Returns true if the arms are those that the scene names, and nothing is wrong with them.
bool armsAreRead(const scene::Scene& draft, const document::Problems& problems) {
  const std::string next = "devices[" + std::to_string(draft.devices.size()) + "]";
  if (placeOfKey(draft.file, next) || (draft.devices.empty() && placeOfKey(draft.file, "device"))) return false;
  return std::none_of(problems.begin(), problems.end(), [&draft](const document::Problem& one) {
    // in another place than the writer meant, after a syntax error
    for (const char* key : {"device", "devices", "mount", "file"})
      if (one.left_out.find(key) != std::string::npos) return true;
    const bool of_arm = one.key.starts_with("device") && one.key.find('.') != std::string::npos;
    return of_arm || std::any_of(draft.devices.begin(), draft.devices.end(), [&one](const scene::Device& device) {
             return device.file.string() == one.place.file;
           });
  });
}

/// Returns what is known of the hands of arms that could be read.
KnownHands knownOfHands(const UnreadKeys& unread, const document::Problems& problems) {
  constexpr std::string_view kOfMotion[] = {"hand.rise",      "hand.rate",    "hand.sweep",  "hand.mass",
                                            "hand.stiffness", "hand.damping", "hand.tremor", "hand.wander"};
  KnownHands known = unread.has("servo") ? KnownHands::kStart : KnownHands::kMotion;
  for (const document::Problem& one : problems) {
    if (one.key == "t") return KnownHands::kNothing;
    if (!one.key.starts_with("hand")) continue;  // `run` would refuse the hand
    if (std::find(std::begin(kOfMotion), std::end(kOfMotion), one.key) == std::end(kOfMotion))
      return KnownHands::kNothing;
    known = KnownHands::kStart;
  }
  return known;
}

/// Judges settings that need the arms.
void judgeArms(const scene::Scene& draft, const UnreadKeys& unread, const ModelTrial& trial,
               document::Problems& problems, document::Problems& warnings) {
  document::append(warnings, fastHands(draft, unread));
  if (!unread.has("clients.max_force")) document::append(warnings, idleBounds(draft));
  if (!unread.has("clients")) document::append(warnings, unguardedPrograms(draft));
  if (!unread.has("servo.velocity")) {
    if (!unread.has("servo.rate") || draft.servo.velocity.estimator == "butterworth")
      document::append(warnings, lateVelocity(draft, trial.needs_velocity));
    if (!unread.has("servo.rate")) document::append(problems, refusedVelocity(draft, trial.needs_velocity, warnings));
  }
  if (!unread.has("servo.rate")) {
    document::append(warnings, unstableContacts(draft, trial.stiffness));
    document::append(warnings, slowArms(draft));
  }
  if (unread.has("servo")) return;
  document::Problems refused = refusedArms(draft, trial.needs_velocity);
  if (unread.has("hand"))  // its directions can be judged without the other keys
    std::erase_if(refused, [&unread](const document::Problem& one) {
      return (one.key != "hand.normal" && one.key != "hand.axis") || unread.has("hand.normal") ||
             unread.has("hand.axis");
    });
  document::append(problems, refused);
}

/// Judges the hands of the arms, with the models that have no problem. Returns true if the hands were moved.
bool judgeHands(const scene::Scene& draft, const UnreadKeys& unread, const DraftModels& models, const ModelTrial& trial,
                const document::Problems& problems, document::Problems& warnings) {
  const bool arms = !draft.devices.empty();
  if (arms && !unread.has("hand")) {
    document::append(warnings, unreachableRows(draft));
    document::append(warnings, pressesThrough(draft, trial.boxes, trial.moves));
  }
  const KnownHands known = arms ? knownOfHands(unread, problems) : KnownHands::kNothing;
  bool moved = false;
  document::append(warnings, models.hands(trial, problems, known, moved));
  return moved && known == KnownHands::kMotion;
}

/// Returns the warnings about single values of a draft.
document::Problems warningsOfValues(const scene::Scene& draft, host::Catalog& catalog) {
  document::Problems warnings = farModels(draft);
  document::append(warnings, farPaths(draft));
  document::append(warnings, slowPaths(draft));
  document::append(warnings, softModels(draft, catalog));
  document::append(warnings, wideScales(draft));
  document::append(warnings, quarantinedModels(draft));
  document::append(warnings, tune::fastPaths(draft));
  return warnings;
}

}  // namespace

bool judgeDraftScene(scene::Scene draft, host::Catalog& catalog, double setup_seconds, document::Problems& problems,
                     document::Problems& warnings) {
  const UnreadKeys unread(problems);
  bool arms = armsAreRead(draft, problems);
  if (arms) draft = withArm(std::move(draft), catalog);
  arms = arms && std::all_of(draft.devices.begin(), draft.devices.end(),
                             [](const scene::Device& device) { return tryModule(device).error.empty(); });
  if (!arms) draft.devices.clear();
  const DraftModels models(draft, unread, catalog);
  const ModelTrial trial = models.attempt(arms ? servo::maxForceOf(draft) : 0, setup_seconds);
  document::append(problems, trial.problems);
  document::append(warnings, trial.warnings);
  for (const document::Problem& one : warningsOfValues(draft, catalog))
    if (models.isRead(one) && !unread.has(one.key)) warnings.push_back(one);
  warnOfSlips(draft.file, warnings);
  if (arms) judgeArms(draft, unread, trial, problems, warnings);
  const bool hands_moved = judgeHands(draft, unread, models, trial, problems, warnings);
  addImplausible(draft, trial.boxes, catalog, unread, warnings);
  if (!arms) std::erase_if(warnings, [](const document::Problem& one) { return one.key == "clients.origin"; });
  return hands_moved;
}

}  // namespace hapticd::diagnostics
