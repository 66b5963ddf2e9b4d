// SPDX-License-Identifier: MIT
#include "cli/check_draft.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <optional>
#include <string_view>
#include <vector>

#include "cli/command.hpp"
#include "cli/scene_warnings.hpp"
#include "diagnostics/device/device_trial.hpp"
#include "diagnostics/device/slow_arm.hpp"
#include "diagnostics/hand/fast_hands.hpp"
#include "diagnostics/hand/hand_path_warnings.hpp"
#include "diagnostics/hand/hand_start.hpp"
#include "diagnostics/hand/hands_of_rest.hpp"
#include "diagnostics/hand/pass_through.hpp"
#include "diagnostics/hand/two_hands.hpp"
#include "diagnostics/reading/given_values.hpp"
#include "diagnostics/reading/key_place.hpp"
#include "diagnostics/reading/model_of_key.hpp"
#include "diagnostics/reading/number_slips.hpp"
#include "diagnostics/scene/far_paths.hpp"
#include "diagnostics/scene/model_trial.hpp"
#include "diagnostics/scene/slow_paths.hpp"
#include "diagnostics/scene/velocity_warnings.hpp"
#include "document/node.hpp"
#include "hapticd/shape.h"
#include "tune/stability.hpp"
#include "world/arm_force.hpp"

namespace hapticd::cli {

using namespace diagnostics;
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

/// What is known of the hands: how they move, or only where they start.
enum class Known { kNothing, kStart, kMotion };

/// Returns what is known of the hands of arms that could be read.
Known knownOfHands(const UnreadKeys& unread, const document::Problems& problems) {
  constexpr std::string_view kOfMotion[] = {"hand.rise",      "hand.rate",    "hand.sweep",  "hand.mass",
                                            "hand.stiffness", "hand.damping", "hand.tremor", "hand.wander"};
  Known known = unread.has("servo") ? Known::kStart : Known::kMotion;
  for (const document::Problem& one : problems) {
    if (one.key == "t") return Known::kNothing;
    if (!one.key.starts_with("hand")) continue;  // `run` would refuse the hand
    if (std::find(std::begin(kOfMotion), std::end(kOfMotion), one.key) == std::end(kOfMotion)) return Known::kNothing;
    known = Known::kStart;
  }
  return known;
}

/// Judges the models of a draft, which is as much of a scene with problems as could be read.
class Models {
 public:
  Models(const scene::Scene& draft, const UnreadKeys& unread) : draft_(draft), left_out_(draft.models.size()) {
    for (size_t i = 0; i < draft.models.size(); ++i) {
      const auto plugin = catalog().shape(draft.models[i].plugin);
      plugins_.push_back(plugin ? *plugin : nullptr);
      unread_.push_back(plugin ? unread.ofModel(i, **plugin) : UnreadModel{});
      lacks_.push_back(plugin && lacksNeeded(draft.models[i], **plugin));
      // a plugin that ships can be asked all the same: it finds what is wrong with the other parameters
      left_out_[i] = !plugin || (lacks_[i] && !host::ships(draft.models[i].library));
    }
  }

  /// Sets up all models that can be set up, with the values that were read.
  ModelTrial attempt(double max_force) const {
    ModelTrial trial = tryModels(draft_, max_force, left_out_);
    for (document::Problems* told : {&trial.problems, &trial.warnings})
      std::erase_if(*told, [this](const document::Problem& one) { return dependsOnUnread(one); });
    for (size_t i = 0; i < trial.boxes.size(); ++i)
      if (unread_[i].ids.contains("instance")) trial.boxes[i].reset();
    for (size_t i = 0; i < trial.stiffness.size(); ++i)
      if (unread_[i].any || !unread_[i].ids.empty()) trial.stiffness[i] = claimOf(i, trial.stiffness[i]);
    return trial;
  }

  /// Returns the warnings about hands, and about how the models lie beside each other, with the models that have no
  /// problem.
  /// @param moved becomes true if there is such a model, so that the hands were moved
  document::Problems hands(const ModelTrial& trial, const document::Problems& problems, Known known,
                           bool& moved) const {
    std::vector<bool> unsound(draft_.models.size()), placed(draft_.models.size(), true), curved(draft_.models.size());
    scene::Scene draft = draft_;
    if (known == Known::kNothing) draft.devices.clear();
    const std::vector<document::Problems> of_models = problemsOfModels(problems, unsound.size());
    const bool wrong_path =  // of which model is not known
        std::any_of(problems.begin(), problems.end(),
                    [](const document::Problem& one) { return one.place.file.ends_with(".csv"); });
    for (size_t i = 0; i < unsound.size(); ++i) {
      curved[i] = !of_models[i].empty() && leaveOutCurves(draft.models[i], i, of_models[i]);
      unsound[i] = plugins_[i] == nullptr || lacks_[i] || !(unread_[i].sound() || curved[i]) ||
                   (wrong_path && draft_.models[i].kinematic);
      for (const document::Problem& one : of_models[i]) {
        if (plugins_[i] != nullptr && UnreadKeys::isReadAsMeant(one, *plugins_[i])) continue;
        unsound[i] = unsound[i] || !curved[i];
        const bool turned = one.key.find("].pose.orientation") != std::string::npos;
        placed[i] = placed[i] && (turned || one.key.find("].pose") == std::string::npos);
      }
    }
    for (const document::Problem& one : trial.warnings)
      if (const auto model = modelOf(one.key); model && *model < unsound.size() && isOfSurfaces(one))
        unsound[*model] = true;
    moved = std::find(unsound.begin(), unsound.end(), false) != unsound.end();
    document::Problems warnings =
        warnOfHandsOfRest(draft, trial.boxes, unsound, placed, catalog(), known == Known::kMotion);
    dropOfCurves(curved, warnings);
    return warnings;
  }

  /// Returns true if a warning about one value of a model can be trusted.
  bool isRead(const document::Problem& one) const {
    const auto model = modelOf(one.key);
    if (!model || *model >= unread_.size()) return true;
    constexpr std::string_view kPosition = ".pose.position", kParameters = ".parameters.";
    if (one.key.ends_with(kPosition)) return !unread_[*model].hasOwn("pose.position");
    const size_t id = one.key.find(kParameters);
    const auto& ids = unread_[*model].ids;
    if (one.key.ends_with("depth_scale") && ids.contains("exponent")) return false;
    return id == std::string::npos || !ids.contains(one.key.substr(id + kParameters.size()));
  }

 private:
  static bool lacksNeeded(const scene::Model& model, const host::ClassInfo& info) {
    return std::any_of(info.params.begin(), info.params.end(), [&model](const host::ParamInfo& param) {
      return (param.flags & HSP_P_REQUIRED) != 0 && givenIn(model.parameters, param.id.c_str()) == nullptr;
    });
  }

  bool isUnread(size_t model, const std::string& id) const {
    return unread_[model].ids.contains(id) ||
           (unread_[model].any && givenIn(draft_.models[model].parameters, id.c_str()) == nullptr);
  }

  /// Returns the stiffness that a model claims, or 0 if it may come from a value that was not read.
  double claimOf(size_t model, double claimed) const {
    for (const char* id : {"stiffness", "exponent", "depth_scale", "dynamics", "contact_ratio", "geometry"})
      if (isUnread(model, id)) return 0;
    return host::ships(draft_.models[model].library) ? claimed : 0;
  }

  /// Returns true if a plugin's message names a parameter that was not read. A message about a file names such
  /// parameters in backquotes; other words of it are keys of the file.
  bool dependsOnUnread(const document::Problem& one) const {
    const auto model = modelOf(one.key);
    if (!model || *model >= unread_.size() || plugins_[*model] == nullptr) return false;
    if (lacks_[*model] && !concernsGiven(one, *model)) return true;
    if (unread_[*model].sound()) return false;
    if (objectsToStandIn(one, *model)) return true;
    const auto& given = draft_.models[*model].parameters;
    const bool of_file = std::any_of(given.begin(), given.end(), [&one](const scene::Value& value) {
      return value.kind == HSP_PATH && one.what.find(value.text + ":") != std::string::npos;
    });
    const auto& params = plugins_[*model]->params;
    return std::any_of(params.begin(), params.end(), [&](const host::ParamInfo& param) {
      return isUnread(*model, param.id) &&
             (of_file ? one.what.find("`" + param.id + "`") != std::string::npos : hasWord(one.what, param.id));
    });
  }

  /// Returns true if a plugin objects to the number that was taken instead of one out of range. Of lists, the other
  /// numbers are as given.
  bool objectsToStandIn(const document::Problem& one, size_t model) const {
    const std::string id = idIn(one.key);
    const scene::Value* value = givenIn(draft_.models[model].parameters, id.c_str());
    return value != nullptr && value->kind == HSP_REAL && unread_[model].ids.contains(id);
  }

  /// Returns the id of the parameter that a key names, such as "detent" of "models[0].parameters.detent[2]".
  static std::string idIn(const std::string& key) {
    constexpr std::string_view kParameters = ".parameters.";
    const size_t at = key.find(kParameters);
    const std::string id = at == std::string::npos ? "" : key.substr(at + kParameters.size());
    return id.substr(0, id.find('['));
  }

  /// Returns true if a message about a model that lacks a needed parameter is about those that it has.
  bool concernsGiven(const document::Problem& one, size_t model) const {
    bool concerns = givenIn(draft_.models[model].parameters, idIn(one.key).c_str()) != nullptr;
    for (const host::ParamInfo& param : plugins_[model]->params) {
      if (!hasWord(one.what, param.id)) continue;
      const bool given = givenIn(draft_.models[model].parameters, param.id.c_str()) != nullptr;
      if (!given && (param.flags & HSP_P_REQUIRED) != 0) return false;
      concerns = concerns || given;
    }
    return concerns;
  }

  static bool hasWord(std::string_view text, std::string_view word) {
    const auto letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    for (size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
      const size_t end = at + word.size();
      if ((at == 0 || !letter(text[at - 1])) && (end >= text.size() || !letter(text[end]))) return true;
    }
    return false;
  }

  const scene::Scene& draft_;
  std::vector<const host::ClassInfo*> plugins_;
  std::vector<UnreadModel> unread_;
  std::vector<bool> left_out_, lacks_;  ///< of each model: it is not tried; it lacks a needed parameter
};

/// Judges settings that need the arms.
void checkDraftArms(const scene::Scene& draft, const UnreadKeys& unread, const ModelTrial& trial,
                    document::Problems& problems, document::Problems& warnings) {
  const auto add = [](document::Problems& to, const document::Problems& more) {
    to.insert(to.end(), more.begin(), more.end());
  };
  for (const document::Problem& one : fastHands(draft, unread)) warnings.push_back(one);
  if (!unread.has("clients.max_force")) add(warnings, idleBounds(draft));
  if (!unread.has("servo.velocity")) {
    if (!unread.has("servo.rate") || draft.servo.velocity.estimator == "butterworth")
      add(warnings, lateVelocity(draft, trial.needs_velocity));
    if (!unread.has("servo.rate")) add(problems, refusedVelocity(draft, trial.needs_velocity, warnings));
  }
  if (!unread.has("servo.rate")) {
    add(warnings, unstableContacts(draft, trial.stiffness));
    add(warnings, slowArms(draft));
  }
  if (unread.has("servo")) return;
  document::Problems refused = refusedArms(draft, trial.needs_velocity);
  if (unread.has("hand"))  // its directions can be judged without the other keys
    std::erase_if(refused, [&unread](const document::Problem& one) {
      return (one.key != "hand.normal" && one.key != "hand.axis") || unread.has("hand.normal") ||
             unread.has("hand.axis");
    });
  add(problems, refused);
}

/// Judges the hands of the arms, with the models that have no problem. Returns true if the hands were moved.
bool checkDraftHands(const scene::Scene& draft, const UnreadKeys& unread, const Models& models, const ModelTrial& trial,
                     const document::Problems& problems, document::Problems& warnings) {
  const bool arms = !draft.devices.empty();
  if (arms && !unread.has("hand"))
    for (const document::Problems& found : {unreachableRows(draft), pressesThrough(draft, trial.boxes)})
      warnings.insert(warnings.end(), found.begin(), found.end());
  const Known known = arms ? knownOfHands(unread, problems) : Known::kNothing;
  bool moved = false;
  for (document::Problem& one : models.hands(trial, problems, known, moved)) warnings.push_back(std::move(one));
  return moved && known == Known::kMotion;
}

}  // namespace

bool checkDraft(scene::Scene draft, document::Problems& problems, document::Problems& warnings) {
  const UnreadKeys unread(problems);
  bool arms = armsAreRead(draft, problems);
  if (arms) draft = withArm(std::move(draft));
  arms = arms && std::all_of(draft.devices.begin(), draft.devices.end(),
                             [](const scene::Device& device) { return tryModule(device).error.empty(); });
  if (!arms) draft.devices.clear();
  const Models models(draft, unread);
  const ModelTrial trial = models.attempt(arms ? servo::maxForceOf(draft) : 0);
  problems.insert(problems.end(), trial.problems.begin(), trial.problems.end());
  warnings.insert(warnings.end(), trial.warnings.begin(), trial.warnings.end());
  for (const auto& found_by :
       {&farModels, &farPaths, &slowPaths, &softModels, &wideScales, &quarantinedModels, &tune::fastPaths})
    for (const document::Problem& one : found_by(draft))
      if (models.isRead(one) && !unread.has(one.key)) warnings.push_back(one);
  document::Problems unparsed;
  if (const auto root = document::readFileOn(draft.file, unparsed)) {
    warnOfZeros(*root, draft.file.string(), warnings);
    warnOfTurns(*root, draft.file.string(), warnings);
    warnOfMounts(*root, draft.file.string(), warnings);
    warnOfTwoHands(*root, draft.file.string(), warnings);
  }
  if (arms) checkDraftArms(draft, unread, trial, problems, warnings);
  const bool hands_moved = checkDraftHands(draft, unread, models, trial, problems, warnings);
  addImplausible(draft, trial.boxes, unread, warnings);
  if (!arms) std::erase_if(warnings, [](const document::Problem& one) { return one.key == "clients.origin"; });
  return hands_moved;
}

}  // namespace hapticd::cli
