// SPDX-License-Identifier: MIT
/// The examination of a device module: what its author must hear before a hand feels it.
#pragma once
#include <string>
#include <vector>

#include "description/scene.hpp"

namespace hapticd::device_check {

enum class Verdict { kPassed, kWarned, kFailed, kSkipped };

struct Outcome {
  const char* name;
  Verdict verdict = Verdict::kPassed;
  std::string what;    ///< what is wrong, why it was skipped, or what was seen
  bool ended = false;  ///< ended by a crash or a hang
};

struct Test {
  const char* name;
  /// "": passed; "skip: why", "warn: what", "note: what was seen"; otherwise what is wrong. Runs in a child process.
  std::string (*run)(const scene::Device& device);
};

/// All tests, in the order in which they run.
const std::vector<Test>& tests();

/// [main] Runs one test in a child process. A crash or a hang is reported with the call in which it happened.
Outcome tryOne(const Test& test, const scene::Device& device, int limit_ms);

}  // namespace hapticd::device_check
