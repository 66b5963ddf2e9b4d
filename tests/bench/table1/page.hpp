// SPDX-License-Identifier: MIT
/// The table as text, as a page and as pictures.
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

/// The goals: average mean within a quarter of the paper's, every mean below 3 mm, every maximum below 12 mm, buzz at
/// most 0.12 mm, at least 10,000 samples in contact, no fault.
struct Verdict {
  bool met = true;
  double mean = 0, std = 0, max = 0;  ///< averages over the rows [mm]
  std::string text;
};

/// The same run with something changed.
struct Variation {
  std::string what;
  record::ContactStatistics depth;
};

/// All that the page shows.
struct Evaluation {
  const std::vector<Row>& rows;
  const std::vector<Variation>& variations;
  const Recording& pressed;  ///< the button, slowly in and out
  const Protocol& protocol;
  const Verdict& verdict;
};

std::string lineOf(const Row& row);
Verdict judge(const std::vector<Row>& rows);
/// [main] FOLDER/table1.md and FOLDER/pictures/table1-*.svg. @throws std::runtime_error
void writePage(const Evaluation& evaluation, const std::string& folder);

}  // namespace hapticd::table1
