// SPDX-License-Identifier: MIT
#include "diagnostics/scene/given_model.hpp"

#include "document/node.hpp"

namespace hapticd::diagnostics {

Eigen::Vector3d GivenModel::gravity() const {
  unsure_ = unsure_ || unread_.gravity || unread_.hasOwn("pose");
  return model().pose.orientation.conjugate() * scene_.servo.gravity;
}

const scene::Value* GivenModel::find(std::string_view id) const {
  const scene::Value* value = givenIn(model().parameters, id);
  unsure_ = unsure_ || unread_.ids.contains(id) || (value == nullptr && unread_.any);
  return value;
}

double GivenModel::number(std::string_view id) const {
  if (const scene::Value* value = find(id)) return value->number;
  const int index = info_.indexOf(std::string(id));
  return index < 0 ? 0 : info_.params[static_cast<size_t>(index)].def;
}

Eigen::Vector3d GivenModel::vector(std::string_view id) const {
  Eigen::Vector3d numbers = Eigen::Vector3d::Zero();
  if (const scene::Value* value = find(id))
    return value->numbers.size() == 3 ? Eigen::Vector3d(value->numbers.data()) : numbers;
  const int index = info_.indexOf(std::string(id));
  if (index < 0 || !info_.params[static_cast<size_t>(index)].def_text) return numbers;
  document::Problems unread;
  const auto list = document::parseText(*info_.params[static_cast<size_t>(index)].def_text, "default", unread);
  if (!list || list->items.size() != 3) return numbers;
  for (size_t i = 0; i < 3; ++i)
    numbers[static_cast<Eigen::Index>(i)] = document::toNumber(list->items[i].scalar).value_or(0);
  return numbers;
}

std::string GivenModel::choice(std::string_view id) const {
  const int index = info_.indexOf(std::string(id));
  if (index < 0) return "";
  const auto& choices = info_.params[static_cast<size_t>(index)].choices;
  const auto chosen = static_cast<size_t>(number(id));
  return chosen < choices.size() ? choices[chosen] : "";
}

void GivenModel::warn(std::initializer_list<std::string_view> ids, const std::string& what, bool also) const {
  if (unsure_) return;
  const std::string key = "models[" + std::to_string(index_) + "].parameters.";
  const scene::Value* at = nullptr;
  for (const std::string_view id : ids)
    if (at == nullptr) at = givenIn(model().parameters, id);
  const std::string told = key + (at != nullptr ? at->id : std::string(*ids.begin()));
  for (size_t i = first_; i < warnings_.size(); ++i)
    if (warnings_[i].key == told && !also) return;
  document::report(warnings_, at != nullptr ? at->place : model().place, told, what);
}

}  // namespace hapticd::diagnostics
