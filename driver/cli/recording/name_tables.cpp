// SPDX-License-Identifier: MIT
#include "cli/recording/name_tables.hpp"

#include <fmt/format.h>

#include "cli/recording/joint_motion.hpp"
#include "cli/recording/tick_times.hpp"
#include "document/csv.hpp"

namespace hapticd::cli {

using document::csvField;

NameTable modelsTable(const servo::RunModels& models) {
  NameTable table{std::string(kModelsHeader) + "\n", models.all().size()};
  for (const servo::RunModel& one : models.all())
    table.text +=
        fmt::format("{},{},{},{}\n", one.number, csvField(one.model.name), csvField(one.model.plugin), one.since);
  return table;
}

NameTable columnsTable(const record::Recording& recording) {
  NameTable table{std::string(kColumnsHeader) + "\n", 0};
  for (const record::RecordedStream& stream : recording.streams())
    for (const record::Column& column : stream.columns()) {
      table.text +=
          fmt::format("{},{},{},{}\n", stream.name(), column.name, csvField(column.unit), csvField(column.doc));
      ++table.rows;
    }
  return table;
}

NameTable jointsTable(const record::Recording& recording, const servo::RunModels& models) {
  NameTable table{std::string(kJointsHeader) + "\n", 0};
  TickTimes times(recording);
  eachJointPlace(recording, models, [&](size_t model, const JointMotion& joint, double tick, const JointPlace& place) {
    table.text += fmt::format("{:.0f},{},{},{},{},{}\n", tick, times.of(tick), csvField(models.all()[model].model.name),
                              joint.unit(), place.position, place.stop);
    ++table.rows;
  });
  return table;
}

}  // namespace hapticd::cli
