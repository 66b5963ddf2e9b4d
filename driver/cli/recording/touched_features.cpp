// SPDX-License-Identifier: MIT
#include "cli/recording/touched_features.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <optional>

#include "cli/recording/recorded_part.hpp"

namespace hapticd::cli {
namespace {

constexpr std::size_t kMostNamed = 5;

using Ticks = std::map<std::uint32_t, std::uint64_t>;  // of each feature

/// The ticks of contact of a model.
struct Touched {
  Ticks ticks;
  std::uint64_t forceless = 0;  ///< ticks in which the model gave no force, because it was faded out
};

/// Returns whether an arm had a fault in a tick: then no force pushed back, so it is no contact, as in the report of a
/// run. Ticks are asked for in their order.
class Faults {
 public:
  explicit Faults(const record::RecordedStream* ticks) : ticks_(ticks) {
    if (ticks_ != nullptr) number_ = ticks_->find("tick");
  }

  bool at(double tick, std::uint32_t arm) {
    if (number_ == nullptr) return false;
    while (row_ < ticks_->rows() && ticks_->number(row_, *number_) < tick) ++row_;
    const record::Column* fault = ticks_->find("arm" + std::to_string(arm) + "_fault");
    return row_ < ticks_->rows() && fault != nullptr && ticks_->number(row_, *fault) != 0;
  }

 private:
  const record::RecordedStream* ticks_;
  const record::Column* number_ = nullptr;
  std::uint64_t row_ = 0;
};

/// Counts the ticks of contact of each feature, for each model, by its place in models.all().
std::map<std::size_t, Touched> contactTicks(const record::RecordedStream& contacts, const record::RecordedStream* all,
                                            const servo::RunModels& models) {
  std::map<std::size_t, Touched> touched;
  const record::Column *tick = contacts.find("tick"), *model = contacts.find("model"), *probe = contacts.find("probe"),
                       *feature = contacts.find("feature"), *depth = contacts.find("depth"),
                       *gain = contacts.find("gain");  // older recordings have no gain
  if (tick == nullptr || model == nullptr || probe == nullptr || feature == nullptr || depth == nullptr) return touched;
  const auto whole = [&](std::uint64_t row, const record::Column& column) {
    return static_cast<std::uint32_t>(contacts.number(row, column));
  };
  Faults faults(all);
  for (std::uint64_t row = 0; row < contacts.rows(); ++row) {
    if (!(contacts.number(row, *depth) > 0) || faults.at(contacts.number(row, *tick), whole(row, *probe))) continue;
    const std::size_t place = models.find(contacts.number(row, *model), contacts.number(row, *tick));
    if (place == servo::RunModels::kNone) continue;
    Touched& one = touched[place];
    ++one.ticks[whole(row, *feature)];
    if (gain != nullptr && contacts.number(row, *gain) == 0) ++one.forceless;
  }
  return touched;
}

/// Returns for how long a touched model gave no force, or "" if it always did.
std::string withoutForce(std::uint64_t ticks, double rate) {
  if (ticks == 0) return "";
  char text[160];
  std::snprintf(text, sizeof text,
                "; for %.3g s of it the model gave no force (it was disabled or silenced, "
                "or waited until the tip had left it)",
                static_cast<double>(ticks) / rate);
  return text;
}

/// Returns the features with the longest contacts, longest first.
std::string longest(const Ticks& ticks, const std::optional<brep::Part>& part, double rate) {
  std::vector<std::pair<std::uint32_t, std::uint64_t>> features(ticks.begin(), ticks.end());
  std::stable_sort(features.begin(), features.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (std::size_t i = 0; i < std::min(features.size(), kMostNamed); ++i) {
    const auto& [feature, count] = features[i];
    char time[40];
    std::snprintf(time, sizeof time, " for %.3g s", static_cast<double>(count) / rate);
    text += (text.empty() ? "" : ", ") + featureNameIn(part, feature) + time;
  }
  if (features.size() > kMostNamed) text += ", and " + std::to_string(features.size() - kMostNamed) + " others";
  return text;
}

}  // namespace

std::vector<std::string> touchedFeatures(const record::Recording& recording, const servo::RunModels& models,
                                         double rate) {
  std::vector<std::string> lines;
  const record::RecordedStream* contacts = recording.stream("contacts");
  if (contacts == nullptr) return lines;
  for (const auto& [place, touched] : contactTicks(*contacts, recording.stream("ticks"), models)) {
    const scene::Model& model = models.all()[place].model;
    lines.push_back(model.name + ": " + longest(touched.ticks, partOf(model), rate) +
                    withoutForce(touched.forceless, rate));
  }
  return lines;
}

}  // namespace hapticd::cli
