// SPDX-License-Identifier: MIT
/// Tables that `export --csv` writes beside the streams, for a person with a spreadsheet: names, units and joints.
#pragma once
#include <cstdint>
#include <string>

#include "record/recording.hpp"
#include "session/replay/run_models.hpp"

namespace hapticd::cli {

/// First columns of the tables, by which a file that may be replaced is known.
constexpr const char *kModelsHeader = "model,name,plugin,from_tick", *kJointsHeader = "tick,t,name,unit,position,stop",
                     *kColumnsHeader = "stream,column,unit,meaning";

/// A table as text, and how many rows it has.
struct NameTable {
  std::string text;
  uint64_t rows = 0;
};

/// [main] Returns a row for each model of the run: the number that it has in all streams, its name, its plugin, and the
/// tick from which on the number means this model.
NameTable modelsTable(const servo::RunModels& models);

/// [main] Returns a row for each column of each stream: its unit and what it means.
NameTable columnsTable(const record::Recording& recording);

/// [main] Returns a row for each tick and hinge or slider: tick, time [s], name of the model, unit of the position (rad
/// or m), position from the pose in the scene, and -1 or 1 where it stands at its lowest or highest end stop, else 0.
/// There are no rows if no model has a joint.
NameTable jointsTable(const record::Recording& recording, const servo::RunModels& models);

}  // namespace hapticd::cli
