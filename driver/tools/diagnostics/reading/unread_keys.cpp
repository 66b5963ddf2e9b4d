// SPDX-License-Identifier: MIT
#include "diagnostics/reading/unread_keys.hpp"

#include <algorithm>

#include "base/nearest_word.hpp"
#include "diagnostics/reading/model_of_key.hpp"

namespace hapticd::diagnostics {
namespace {

constexpr std::string_view kModels = "models[", kParameters = "parameters";

/// Returns true if `key` is `whole`, or a part of it, such as "a.b" or "a[1]" of "a".
bool isPartOf(std::string_view key, std::string_view whole) {
  return key.starts_with(whole) && (key.size() == whole.size() || key[whole.size()] == '.' || key[whole.size()] == '[');
}

/// Returns the key of a problem without that of its model, "models[3].".
std::string ownOf(const std::string& key) {
  const size_t end = key.starts_with(kModels) ? key.find(']') : std::string::npos;
  if (end == std::string::npos) return key;
  return key.substr(key.compare(end + 1, 1, ".") == 0 ? end + 2 : end + 1);
}

}  // namespace

UnreadKeys::UnreadKeys(const document::Problems& problems) {
  for (const document::Problem& one : problems) {
    if (one.key == "models") continue;  // no list: its elements were read all the same
    const auto model = modelOf(one.key);
    if (!model) {
      keys_.push_back(one.key);
      // An unknown key of the servo may stand for gravity; a wrong value of another key does not.
      if (one.key.starts_with("servo.") && one.kind == document::ProblemKind::kUnknownKey)
        keys_.emplace_back("servo.gravity");
      continue;
    }
    if (one.kind == document::ProblemKind::kUnusedValue) continue;  // the path was read
    of_models_[*model].push_back(one);
  }
}

bool UnreadKeys::has(std::string_view key) const {
  return std::any_of(keys_.begin(), keys_.end(),
                     [key](const std::string& one) { return isPartOf(one, key) || isPartOf(key, one); });
}

bool UnreadKeys::isReadAsMeant(const document::Problem& one, const host::ClassInfo& info) {
  if (one.kind == document::ProblemKind::kMisspeltKey) return true;
  const std::string own = ownOf(one.key);
  return own != "motion" && own != "path" && info.indexOf(own) >= 0;
}

void UnreadKeys::addOwn(const std::string& key, UnreadModel& model) const {
  for (const char* own : {"name", "plugin", "pose", "parameters", "motion", "path"})
    if (isPartOf(key, own)) {
      model.own.insert(own);
      if (own == std::string_view("pose") && !key.starts_with("pose.orientation")) model.own.insert("pose.position");
      model.any = model.any || key == kParameters;
      return;
    }
  model.any = true;  // the key is unknown, or stands for the whole model
}

void UnreadKeys::addParameter(const std::string& key, const host::ClassInfo& info, UnreadModel& model) const {
  const std::string id = key.substr(0, key.find('['));
  for (const host::ParamInfo& param : info.params)
    if (isPartOf(param.id, id)) model.ids.insert(param.id);  // the parameter itself, or the group that it belongs to
  if (std::any_of(info.params.begin(), info.params.end(),
                  [&id](const host::ParamInfo& param) { return isPartOf(param.id, id); }))
    return;
  const std::string meant = nearestWord(id, info.paramIds());
  if (meant.empty())
    model.any = true;
  else
    model.ids.insert(meant);
}

UnreadModel UnreadKeys::ofModel(size_t index, const host::ClassInfo& info) const {
  UnreadModel model;
  model.gravity = has("servo.gravity");
  const auto found = of_models_.find(index);
  if (found == of_models_.end()) return model;
  for (const document::Problem& one : found->second) {
    const std::string key = ownOf(one.key);
    if (isReadAsMeant(one, info)) continue;
    if (key.starts_with("parameters."))
      addParameter(key.substr(kParameters.size() + 1), info, model);
    else
      addOwn(key, model);
  }
  for (const char* both : {"motion", "path"})  // these are keys of the model and may also be parameters of its plugin
    if (model.own.contains(both)) model.ids.insert(both);
  return model;
}

}  // namespace hapticd::diagnostics
