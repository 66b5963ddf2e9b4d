// SPDX-License-Identifier: MIT
/// Shows how far a long import is, in one line of a terminal. A log gets nothing.
#pragma once
#include <chrono>
#include <cstddef>
#include <string>

namespace hapticd::importing {

class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const std::string& what);  ///< [main] names the step that begins
  /// [main] Shows how much of a step is done, ten times a second at most.
  void show(const std::string& what, std::size_t done, std::size_t all);
  void clear();  ///< [main] call it before something else is printed

 private:
  bool terminal_, drawn_ = false;
  std::chrono::steady_clock::time_point shown_;
};

}  // namespace hapticd::importing
