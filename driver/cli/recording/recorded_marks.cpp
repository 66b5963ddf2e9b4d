// SPDX-License-Identifier: MIT
#include "cli/recording/recorded_marks.hpp"

#include "base/mark_text.hpp"

namespace hapticd::cli {

std::vector<std::pair<double, std::string>> recordedMarks(const record::Recording& recording) {
  std::vector<std::pair<double, std::string>> all;
  const record::RecordedStream* marks = recording.stream("marks");
  const record::Column* t = marks != nullptr ? marks->find("t") : nullptr;
  const record::Column* text = marks != nullptr ? marks->find("text") : nullptr;
  if (t == nullptr || text == nullptr) return all;
  const record::Column* model = marks->find("model");  // older recordings have only marks of programs
  for (uint64_t row = 0; row < marks->rows(); ++row) {
    if (model != nullptr && marks->number(row, *model) >= 0) continue;
    const std::string said = marks->text(row, *text);
    all.emplace_back(marks->number(row, *t), isMarkText(said) ? said : "?");
  }
  return all;
}

}  // namespace hapticd::cli
