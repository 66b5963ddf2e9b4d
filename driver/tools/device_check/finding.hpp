// SPDX-License-Identifier: MIT
/// What one test of a device module found: made in a child process, printed by its parent.
#pragma once
#include <optional>
#include <string>

namespace hapticd::device_check {

enum class Verdict { kPassed, kWarned, kFailed, kSkipped };

struct Finding {
  Verdict verdict = Verdict::kPassed;
  std::string what;   ///< what is wrong, why it was skipped, or what was seen
  bool ends = false;  ///< the tests after it mean nothing, or cannot be run

  static Finding passed(std::string seen = "") { return {Verdict::kPassed, std::move(seen), false}; }
  static Finding warned(std::string what) { return {Verdict::kWarned, std::move(what), false}; }
  static Finding failed(std::string what) { return {Verdict::kFailed, std::move(what), false}; }
  static Finding skipped(std::string why) { return {Verdict::kSkipped, std::move(why), false}; }
  /// An objection, or "" where there is none.
  static Finding of(std::string wrong) { return wrong.empty() ? passed() : failed(std::move(wrong)); }
  /// Nothing else can be tried then.
  Finding andEnds() && {
    ends = true;
    return std::move(*this);
  }
};

/// How a finding goes through a pipe. nullopt: these bytes are no finding.
std::string toBytes(const Finding& finding);
std::optional<Finding> findingFrom(const std::string& bytes);

}  // namespace hapticd::device_check
