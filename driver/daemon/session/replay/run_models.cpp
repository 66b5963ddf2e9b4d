// SPDX-License-Identifier: MIT
#include "session/replay/run_models.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "record/scene_json.hpp"
#include "servo/core/order.hpp"

namespace hapticd::servo {

namespace {

constexpr double kMostNumbers = 65536;                ///< a larger number of a model is damage
constexpr size_t kMostDescription = size_t{1} << 16;  ///< [bytes] the daemon writes at most a tenth of this

constexpr auto kAdopted = static_cast<uint32_t>(Order::Kind::kAdopt);

/// A number of a damaged file may be anything, and a conversion of it would be undefined.
uint64_t wholeTick(double tick) {
  constexpr double kMost = 1e15;
  return tick > 0 ? static_cast<uint64_t>(std::min(tick, kMost)) : 0;
}

bool isNumber(double number) {
  return number >= 0 && number < kMostNumbers;
}

scene::Model nameless(uint32_t number) {
  scene::Model model;
  model.name = "model " + std::to_string(number);
  return model;
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
  for (const scene::Model& model : scene.models) models_.push_back({static_cast<uint32_t>(models_.size()), 0, model});
  readDescriptions(recording.stream("marks"));
  addNameless(recording.stream("orders"), scene.models.size());
  std::stable_sort(models_.begin() + static_cast<std::ptrdiff_t>(scene.models.size()), models_.end(),
                   [](const RunModel& a, const RunModel& b) { return a.since < b.since; });
  for (size_t i = 0; i < models_.size(); ++i) {
    const uint32_t number = models_[i].number;
    if (number >= of_number_.size()) of_number_.resize(number + 1);
    of_number_[number].push_back(i);
  }
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
    const auto place = static_cast<uint32_t>(number);
    auto model = record::modelFromJson(text);
    text.clear();
    models_.push_back({place, wholeTick(marks->number(row, *columns[0])), model ? std::move(*model) : nameless(place)});
  }
}

/// Adds a model without a name for each one that came without a description, so that it does not get the name of the
/// model that had its number before.
void RunModels::addNameless(const record::RecordedStream* orders, size_t of_scene) {
  if (orders == nullptr) return;
  const auto columns = columnsOf(*orders, {"tick", "kind", "target"});
  if (columns.empty()) return;
  std::map<uint32_t, std::set<uint64_t>> described;  // ticks of the descriptions that no order has used up
  for (size_t i = of_scene; i < models_.size(); ++i) described[models_[i].number].insert(models_[i].since);
  for (uint64_t row = 0; row < orders->rows(); ++row) {
    const double number = orders->number(row, *columns[2]);
    if (orders->number(row, *columns[1]) != double{kAdopted} || !isNumber(number)) continue;
    const auto place = static_cast<uint32_t>(number);
    const uint64_t tick = wholeTick(orders->number(row, *columns[0]));
    std::set<uint64_t>& ticks = described[place];
    const auto later = ticks.upper_bound(tick);
    if (later == ticks.begin()) models_.push_back({place, tick, nameless(place)});
    ticks.erase(ticks.begin(), later);
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
  return isNumber(number) ? nameless(static_cast<uint32_t>(number)).name : "a model";
}

}  // namespace hapticd::servo
