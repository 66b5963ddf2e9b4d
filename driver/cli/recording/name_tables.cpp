// SPDX-License-Identifier: MIT
#include "cli/recording/name_tables.hpp"

#include <fmt/format.h>

#include "cli/recording/joint_motion.hpp"
#include "cli/recording/tick_times.hpp"
#include "document/csv.hpp"

namespace hapticd::cli {

using document::csvField;

NameTable modelsTable(const scene::Scene& scene) {
  NameTable table{std::string(kModelsHeader) + "\n", 0};
  for (const scene::Model& model : scene.models)
    table.text += fmt::format("{},{},{}\n", table.rows++, csvField(model.name), csvField(model.plugin));
  return table;
}

NameTable jointsTable(const record::Recording& recording, const scene::Scene& scene) {
  NameTable table{std::string(kJointsHeader) + "\n", 0};
  TickTimes times(recording);
  eachJointPlace(recording, scene, [&](size_t model, const JointMotion& joint, double tick, const JointPlace& place) {
    table.text += fmt::format("{:.0f},{},{},{},{},{}\n", tick, times.of(tick), csvField(scene.models[model].name),
                              joint.unit(), place.position, place.stop);
    ++table.rows;
  });
  return table;
}

}  // namespace hapticd::cli
