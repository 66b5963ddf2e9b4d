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
  bool ended = false;  ///< by a crash or a hang
};

struct Test {
  const char* name;
  /// "": passed; "skip: why", "warn: what", "note: what was seen"; otherwise what is wrong. Runs in a child process.
  std::string (*run)(const scene::Device& device);
};

/// All of them, in the order in which they run.
const std::vector<Test>& tests();

/// [main] Runs one in a child process of its own. A crash or a hang names the call in which it came.
Outcome tryOne(const Test& test, const scene::Device& device, int limit_ms);

}  // namespace hapticd::device_check
