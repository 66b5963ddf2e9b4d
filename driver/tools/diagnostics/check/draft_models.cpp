// SPDX-License-Identifier: MIT
#include "diagnostics/check/draft_models.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "diagnostics/hand/hands_beside_problems.hpp"
#include "diagnostics/reading/given_values.hpp"
#include "diagnostics/reading/model_of_key.hpp"
#include "hapticd/shape.h"

namespace hapticd::diagnostics {
namespace {

bool lacksNeeded(const scene::Model& model, const host::ClassInfo& info) {
  return std::any_of(info.params.begin(), info.params.end(), [&model](const host::ParamInfo& param) {
    return (param.flags & HSP_P_REQUIRED) != 0 && givenIn(model.parameters, param.id) == nullptr;
  });
}

/// Returns the id of the parameter that a key names, such as "detent" of "models[0].parameters.detent[2]".
std::string idIn(const std::string& key) {
  constexpr std::string_view kParameters = ".parameters.";
  const size_t at = key.find(kParameters);
  const std::string id = at == std::string::npos ? "" : key.substr(at + kParameters.size());
  return id.substr(0, id.find('['));
}

/// Returns true if a text contains a whole word.
bool hasWord(std::string_view text, std::string_view word) {
  const auto letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
    const size_t end = at + word.size();
    if ((at == 0 || !letter(text[at - 1])) && (end >= text.size() || !letter(text[end]))) return true;
  }
  return false;
}

}  // namespace

DraftModels::DraftModels(const scene::Scene& draft, const UnreadKeys& unread, host::Catalog& catalog)
    : draft_(draft), catalog_(catalog), left_out_(draft.models.size()) {
  for (size_t i = 0; i < draft.models.size(); ++i) {
    const auto plugin = catalog.shape(draft.models[i].plugin);
    plugins_.push_back(plugin ? *plugin : nullptr);
    unread_.push_back(plugin ? unread.ofModel(i, **plugin) : UnreadModel{});
    lacks_.push_back(plugin && lacksNeeded(draft.models[i], **plugin));
    // a plugin that ships can be asked all the same: it finds what is wrong with the other parameters
    left_out_[i] = !plugin || (lacks_[i] && !host::ships(draft.models[i].library));
  }
}

ModelTrial DraftModels::attempt(double max_force, double setup_seconds) const {
  ModelTrial trial = tryModels(draft_, max_force, left_out_, setup_seconds);
  for (document::Problems* told : {&trial.problems, &trial.warnings})
    std::erase_if(*told, [this](const document::Problem& one) { return dependsOnUnread(one); });
  std::erase_if(trial.warnings, [this](const document::Problem& one) { return isOfUnknownPart(one); });
  for (size_t i = 0; i < trial.boxes.size(); ++i)
    if (isPartUnknown(i)) trial.boxes[i].reset();
  for (size_t i = 0; i < trial.stiffness.size(); ++i)
    if (unread_[i].any || !unread_[i].ids.empty()) trial.stiffness[i] = claimOf(i, trial.stiffness[i]);
  return trial;
}

document::Problems DraftModels::hands(const ModelTrial& trial, const document::Problems& problems, KnownHands known,
                                      bool& moved) const {
  std::vector<bool> unsound(draft_.models.size()), placed(draft_.models.size(), true), curved(draft_.models.size());
  scene::Scene draft = draft_;
  if (known == KnownHands::kNothing) draft.devices.clear();
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
      warnOfHandsBesideProblems(draft, trial.boxes, unsound, placed, catalog_, known == KnownHands::kMotion);
  dropOfCurves(curved, warnings);
  return warnings;
}

bool DraftModels::isRead(const document::Problem& one) const {
  const auto model = modelOf(one.key);
  if (!model || *model >= unread_.size()) return true;
  constexpr std::string_view kPosition = ".pose.position", kParameters = ".parameters.";
  if (one.key.ends_with(kPosition)) return !unread_[*model].hasOwn("pose.position");
  const size_t id = one.key.find(kParameters);
  const auto& ids = unread_[*model].ids;
  if (one.key.ends_with("depth_scale") && ids.contains("exponent")) return false;
  return id == std::string::npos || !ids.contains(one.key.substr(id + kParameters.size()));
}

bool DraftModels::isUnread(size_t model, const std::string& id) const {
  return unread_[model].ids.contains(id) ||
         (unread_[model].any && givenIn(draft_.models[model].parameters, id) == nullptr);
}

bool DraftModels::isPartUnknown(size_t model) const {
  return unread_[model].ids.contains("instance") || unread_[model].ids.contains("without");
}

bool DraftModels::isOfUnknownPart(const document::Problem& one) const {
  const auto model = modelOf(one.key);
  return model && *model < unread_.size() && isPartUnknown(*model) && one.key.find('.') == one.key.npos;
}

double DraftModels::claimOf(size_t model, double claimed) const {
  for (const char* id : {"stiffness", "exponent", "depth_scale", "dynamics", "contact_ratio", "geometry"})
    if (isUnread(model, id)) return 0;
  return host::ships(draft_.models[model].library) ? claimed : 0;
}

bool DraftModels::dependsOnUnread(const document::Problem& one) const {
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

bool DraftModels::objectsToStandIn(const document::Problem& one, size_t model) const {
  const std::string id = idIn(one.key);
  const scene::Value* value = givenIn(draft_.models[model].parameters, id);
  return value != nullptr && value->kind == HSP_REAL && unread_[model].ids.contains(id);
}

bool DraftModels::concernsGiven(const document::Problem& one, size_t model) const {
  bool concerns = givenIn(draft_.models[model].parameters, idIn(one.key)) != nullptr;
  for (const host::ParamInfo& param : plugins_[model]->params) {
    if (!hasWord(one.what, param.id)) continue;
    const bool given = givenIn(draft_.models[model].parameters, param.id) != nullptr;
    if (!given && (param.flags & HSP_P_REQUIRED) != 0) return false;
    concerns = concerns || given;
  }
  return concerns;
}

}  // namespace hapticd::diagnostics
