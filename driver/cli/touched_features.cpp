// SPDX-License-Identifier: MIT
#include "cli/touched_features.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <optional>
#include <span>

#include "base/regular_file.hpp"
#include "kernels/brep/part_file.hpp"
#include "kernels/brep/part_limit.hpp"
#include "kernels/brep/part_names.hpp"

namespace hapticd::cli {
namespace {

constexpr std::size_t kMostNamed = 5;

using Ticks = std::map<std::uint32_t, std::uint64_t>;  // of each feature

/// Counts the ticks of contact of each feature, for each place of a model.
std::map<std::uint32_t, Ticks> contactTicks(const record::RecordedStream& contacts) {
  std::map<std::uint32_t, Ticks> ticks;
  const record::Column *model = contacts.find("model"), *feature = contacts.find("feature"),
                       *depth = contacts.find("depth");
  if (model == nullptr || feature == nullptr || depth == nullptr) return ticks;
  for (std::uint64_t row = 0; row < contacts.rows(); ++row)
    if (contacts.number(row, *depth) > 0)
      ++ticks[static_cast<std::uint32_t>(contacts.number(row, *model))]
             [static_cast<std::uint32_t>(contacts.number(row, *feature))];
  return ticks;
}

/// Reads the part of a model. Returns nothing if the model has none, or if the file cannot be read any more.
std::optional<brep::Part> partOf(const scene::Model& model) {
  for (const scene::Value& value : model.parameters) {
    if (value.id != "geometry" || !value.text.ends_with(".hpart")) continue;
    const auto bytes = readRegular(value.text, brep::kMostPartBytes);
    if (!bytes) return {};
    try {
      return brep::readPart(std::as_bytes(std::span(*bytes)), value.text);
    } catch (const brep::PartError&) {
      return {};
    }
  }
  return {};
}

/// Returns the features with the longest contacts, longest first.
std::string longest(const Ticks& ticks, const std::optional<brep::Part>& part, double rate) {
  std::vector<std::pair<std::uint32_t, std::uint64_t>> features(ticks.begin(), ticks.end());
  std::stable_sort(features.begin(), features.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (std::size_t i = 0; i < std::min(features.size(), kMostNamed); ++i) {
    const auto& [feature, count] = features[i];
    std::string name = part ? brep::featureName(*part, feature) : "";
    if (name.empty()) name = "feature " + std::to_string(feature);
    char time[40];
    std::snprintf(time, sizeof time, " for %.3g s", static_cast<double>(count) / rate);
    text += (text.empty() ? "" : ", ") + name + time;
  }
  if (features.size() > kMostNamed) text += ", and " + std::to_string(features.size() - kMostNamed) + " others";
  return text;
}

}  // namespace

std::vector<std::string> touchedFeatures(const record::Recording& recording, const scene::Scene& scene, double rate) {
  std::vector<std::string> lines;
  const record::RecordedStream* contacts = recording.stream("contacts");
  if (contacts == nullptr) return lines;
  for (const auto& [place, ticks] : contactTicks(*contacts)) {
    const bool known = place < scene.models.size();  // others were added during the run
    const std::string name = known ? scene.models[place].name : "model " + std::to_string(place);
    const auto part = known ? partOf(scene.models[place]) : std::nullopt;
    lines.push_back(name + ": " + longest(ticks, part, rate));
  }
  return lines;
}

}  // namespace hapticd::cli
