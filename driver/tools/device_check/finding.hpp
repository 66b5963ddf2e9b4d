// SPDX-License-Identifier: MIT
/// The result of one test of a device module: a child process makes it, and its parent prints it.
#pragma once
#include <optional>
#include <string>

namespace hapticd::device_check {

enum class Verdict { kPassed, kWarned, kFailed, kSkipped };

struct Finding {
  Verdict verdict = Verdict::kPassed;
  std::string what;   ///< what is wrong, why it was skipped, or what was seen
  bool ends = false;  ///< true if the tests after this one mean nothing or cannot be run

  static Finding passed(std::string seen = "") { return {Verdict::kPassed, std::move(seen), false}; }
  static Finding warned(std::string what) { return {Verdict::kWarned, std::move(what), false}; }
  static Finding failed(std::string what) { return {Verdict::kFailed, std::move(what), false}; }
  static Finding skipped(std::string why) { return {Verdict::kSkipped, std::move(why), false}; }
  /// Makes a failed finding from a text that says what is wrong, or a passed one from "".
  static Finding of(std::string wrong) { return wrong.empty() ? passed() : failed(std::move(wrong)); }
  /// Marks this finding as one after which no other test can be run.
  Finding andEnds() && {
    ends = true;
    return std::move(*this);
  }
};

/// Convert a finding to the bytes that go through a pipe, and back. findingFrom() returns nullopt if the bytes are not
/// a finding.
std::string toBytes(const Finding& finding);
std::optional<Finding> findingFrom(const std::string& bytes);

}  // namespace hapticd::device_check
