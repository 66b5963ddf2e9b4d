// SPDX-License-Identifier: MIT
/// Tables that `export --csv` writes beside the streams, for a person with a spreadsheet: names and joints.
#pragma once
#include <cstdint>
#include <string>

#include "description/scene.hpp"
#include "record/recording.hpp"

namespace hapticd::cli {

/// First columns of the tables, by which a file that may be replaced is known.
constexpr const char *kModelsHeader = "model,name,plugin", *kJointsHeader = "tick,t,name,unit,position,stop";

/// A table as text, and how many rows it has.
struct NameTable {
  std::string text;
  uint64_t rows = 0;
};

/// [main] Returns a row for each model of the scene: the number that it has in all streams, its name, its plugin.
NameTable modelsTable(const scene::Scene& scene);

/// [main] Returns a row for each tick and hinge or slider: tick, time [s], name of the model, unit of the position (rad
/// or m), position from the pose in the scene, and -1 or 1 where it stands at its lowest or highest end stop, else 0.
/// There are no rows if the scene has no joint.
NameTable jointsTable(const record::Recording& recording, const scene::Scene& scene);

}  // namespace hapticd::cli
