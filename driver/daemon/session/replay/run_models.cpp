// SPDX-License-Identifier: MIT
#include "session/replay/run_models.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "servo/core/order.hpp"
#include "session/replay/model_description.hpp"

namespace hapticd::servo {

namespace {

constexpr double kMostNumbers = 65536;                ///< a larger number of a model is damage
constexpr size_t kMostDescription = size_t{1} << 18;  ///< [bytes] the daemon writes at most half of this

constexpr auto kAdopted = static_cast<uint32_t>(Order::Kind::kAdopt),
               kReleased = static_cast<uint32_t>(Order::Kind::kRelease);

/// A number of a damaged file may be anything, and a conversion of it would be undefined.
uint64_t wholeTick(double tick) {
  constexpr double kMost = 1e15;
  return tick > 0 ? static_cast<uint64_t>(std::min(tick, kMost)) : 0;
}

bool isNumber(double number) {
  return number >= 0 && number < kMostNumbers;
}

RunModel nameless(uint32_t number, uint64_t since, const char* lack) {
  RunModel one{number, since, UINT64_MAX, {}, {}, lack};
  one.model.name = "model " + std::to_string(number);
  return one;
}

/// The model that a text of the daemon describes.
RunModel described(uint32_t number, uint64_t since, const std::string& text) {
  auto description = readModelDescription(text);
  if (!description) return nameless(number, since, "its description in the stream marks is damaged");
  RunModel one{number, since, UINT64_MAX, std::move(description->model), std::move(description->files), ""};
  if (!description->whole)
    one.lack = "the recording describes it only in part, because its path and parameters are long";
  return one;
}

/// The columns of some names; empty if one is missing.
std::vector<const record::Column*> columnsOf(const record::RecordedStream& stream,
                                             std::initializer_list<const char*> names) {
  std::vector<const record::Column*> columns;
  for (const char* name : names)
    if (const record::Column* column = stream.find(name)) columns.push_back(column);
  return columns.size() == names.size() ? columns : std::vector<const record::Column*>();
}

}  // namespace

RunModels::RunModels(const record::Recording& recording, const scene::Scene& scene) {
  for (const scene::Model& model : scene.models)
    models_.push_back({static_cast<uint32_t>(models_.size()), 0, UINT64_MAX, model});
  of_scene_ = static_cast<std::ptrdiff_t>(models_.size());
  readDescriptions(recording.stream("marks"));
  addNameless(recording.stream("orders"));
  std::stable_sort(models_.begin() + of_scene_, models_.end(),
                   [](const RunModel& a, const RunModel& b) { return a.since < b.since; });
  for (size_t i = 0; i < models_.size(); ++i) {
    const uint32_t number = models_[i].number;
    if (number >= of_number_.size()) of_number_.resize(number + 1);
    of_number_[number].push_back(i);
  }
  noteLeaving(recording.stream("orders"));
}

/// Adds the models that the daemon has described. A description that lacks its begin, or is damaged, gives no name.
void RunModels::readDescriptions(const record::RecordedStream* marks) {
  if (marks == nullptr) return;
  const auto columns = columnsOf(*marks, {"tick", "model", "left", "text"});
  if (columns.empty()) return;  // an older recording
  std::string text;
  for (uint64_t row = 0; row < marks->rows(); ++row) {
    const double number = marks->number(row, *columns[1]);
    if (!isNumber(number)) continue;  // a mark of a program
    if (text.size() < kMostDescription) text += marks->text(row, *columns[3]);
    if (marks->number(row, *columns[2]) > 0) continue;
    models_.push_back(described(static_cast<uint32_t>(number), wholeTick(marks->number(row, *columns[0])), text));
    text.clear();
  }
}

/// Adds a model without a name for each one that came without a description, so that it does not get the name of the
/// model that had its number before.
void RunModels::addNameless(const record::RecordedStream* orders) {
  if (orders == nullptr) return;
  const auto columns = columnsOf(*orders, {"tick", "kind", "target"});
  if (columns.empty()) return;
  std::map<uint32_t, std::set<uint64_t>> unused;  // ticks of the descriptions that no order has used up
  for (auto one = models_.begin() + of_scene_; one != models_.end(); ++one) unused[one->number].insert(one->since);
  for (uint64_t row = 0; row < orders->rows(); ++row) {
    const double number = orders->number(row, *columns[2]);
    if (orders->number(row, *columns[1]) != double{kAdopted} || !isNumber(number)) continue;
    const auto place = static_cast<uint32_t>(number);
    const uint64_t tick = wholeTick(orders->number(row, *columns[0]));
    std::set<uint64_t>& ticks = unused[place];
    const auto later = ticks.upper_bound(tick);
    if (later == ticks.begin())
      models_.push_back(nameless(place, tick,
                                 "the recording does not describe it: an older hapticd made it, or its "
                                 "rows in the stream marks are lost"));
    ticks.erase(ticks.begin(), later);
  }
}

/// Notes when models left. A model has left at the latest when another one gets its number.
void RunModels::noteLeaving(const record::RecordedStream* orders) {
  for (const std::vector<size_t>& had : of_number_)
    for (size_t i = 1; i < had.size(); ++i) models_[had[i - 1]].until = models_[had[i]].since;
  if (orders == nullptr) return;
  const auto columns = columnsOf(*orders, {"tick", "kind", "target"});
  for (uint64_t row = 0; !columns.empty() && row < orders->rows(); ++row) {
    if (orders->number(row, *columns[1]) != double{kReleased}) continue;
    const double tick = orders->number(row, *columns[0]);
    const size_t place = find(orders->number(row, *columns[2]), tick);
    if (place != kNone) models_[place].until = std::min(models_[place].until, wholeTick(tick));
  }
}

size_t RunModels::find(double number, double tick) const {
  if (!(number >= 0 && number < static_cast<double>(of_number_.size()))) return kNone;
  const std::vector<size_t>& had = of_number_[static_cast<size_t>(number)];
  const auto later = std::find_if(had.begin(), had.end(),
                                  [&](size_t place) { return static_cast<double>(models_[place].since) > tick; });
  return later == had.begin() ? kNone : *(later - 1);
}

std::string RunModels::nameOf(double number, double tick) const {
  const size_t place = find(number, tick);
  if (place != kNone) return models_[place].model.name;
  return isNumber(number) ? nameless(static_cast<uint32_t>(number), 0, "").model.name : "a model";
}

}  // namespace hapticd::servo
