// SPDX-License-Identifier: MIT
/// Writes the table as text, as a page of Markdown and as pictures.
#pragma once
#include <string>
#include <vector>

#include "session.hpp"

namespace hapticd::table1 {

struct Row {
  std::string subject;
  bool moving;
  Depths paper;
  Recording recording;
};

/// Whether the goals are met: the average of the mean depths differs from the paper's by at most a quarter, every mean
/// is below 3 mm, every maximum below 12 mm, buzz is at most 0.12 mm, each row has at least 10,000 samples in contact,
/// and there is no fault.
struct Verdict {
  bool met = true;
  double mean = 0, std = 0, max = 0;  ///< averages over the rows [mm]
  std::string text;
};

/// A repeated run with one number of the protocol changed.
struct Variation {
  std::string what;
  record::ContactStatistics depth;
};

/// The contents of the page.
struct Evaluation {
  const std::vector<Row>& rows;
  const std::vector<Variation>& variations;
  const Recording& pressed;  ///< the button, pressed slowly in and out
  const Protocol& protocol;
  const Verdict& verdict;
};

std::string lineOf(const Row& row);
Verdict judge(const std::vector<Row>& rows);
/// [main] Writes FOLDER/table1.md and FOLDER/pictures/table1-*.svg. @throws std::runtime_error if a file cannot be
/// written
void writePage(const Evaluation& evaluation, const std::string& folder);

}  // namespace hapticd::table1
