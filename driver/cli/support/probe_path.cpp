// SPDX-License-Identifier: MIT
#include "cli/support/probe_path.hpp"

#include <fmt/format.h>

#include <cmath>

#include "document/csv.hpp"

namespace hapticd::cli {

Result<std::vector<PathRow>> readProbePath(const std::string& file) {
  constexpr size_t kMaxBytes = size_t{4} << 30;  // [bytes] enough for ten hours at 1 kHz
  constexpr size_t kPoseColumns = 8;
  const document::CsvRules rules{{"t,x,y,z", "t,x,y,z,qw,qx,qy,qz"}, false, true, HUGE_VAL};
  document::Problems problems;
  const auto table = document::readCsv(file, kMaxBytes, rules, problems);
  if (!table) return Error{document::textOf(problems)};
  std::vector<PathRow> rows(table->rows());
  constexpr double kLengthError = 1e-3;  // quaternions with seven digits pass; degrees or zeros do not
  for (size_t i = 0; i < rows.size(); ++i) {
    const double* v = table->row(i);
    rows[i].t = v[0];
    rows[i].position = {v[1], v[2], v[3]};
    if (table->columns == kPoseColumns) rows[i].orientation = {v[4], v[5], v[6], v[7]};
    const double length = rows[i].orientation.norm();
    if (!rows[i].orientation.coeffs().allFinite() || std::abs(length - 1) <= kLengthError)
      continue;  // a row of NaN is a gap without samples
    return Error{
        fmt::format("{}:{}: qw,qx,qy,qz: ({:g}, {:g}, {:g}, {:g}) has the length {:.4g}; expected a unit quaternion",
                    file, table->lines[i], v[4], v[5], v[6], v[7], length)};
  }
  return rows;
}

}  // namespace hapticd::cli
