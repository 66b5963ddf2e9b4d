// SPDX-License-Identifier: MIT
#include "cli/recording/name_tables.hpp"

#include <fmt/format.h>

#include "cli/recording/joint_motion.hpp"
#include "cli/recording/tick_times.hpp"

namespace hapticd::cli {
namespace {

/// Returns a text as a field of a CSV file (RFC 4180).
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string all = "\"";
  for (const char c : text) all += c == '"' ? "\"\"" : std::string(1, c);
  return all + "\"";
}

}  // namespace

NameTable modelsTable(const scene::Scene& scene) {
  NameTable table{std::string(kModelsHeader) + "\n", 0};
  for (const scene::Model& model : scene.models)
    table.text += fmt::format("{},{},{}\n", table.rows++, field(model.name), field(model.plugin));
  return table;
}

NameTable jointsTable(const record::Recording& recording, const scene::Scene& scene) {
  NameTable table{std::string(kJointsHeader) + "\n", 0};
  TickTimes times(recording);
  eachJointPlace(recording, scene, [&](size_t model, const JointMotion& joint, double tick, const JointPlace& place) {
    table.text += fmt::format("{:.0f},{},{},{},{},{}\n", tick, times.of(tick), field(scene.models[model].name),
                              joint.unit(), place.position, place.stop);
    ++table.rows;
  });
  return table;
}

}  // namespace hapticd::cli
