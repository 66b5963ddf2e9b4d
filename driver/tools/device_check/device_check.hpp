// SPDX-License-Identifier: MIT
/// The examination of a device module: what its author must hear before a hand feels it.
#pragma once
#include <vector>

#include "description/scene.hpp"
#include "device_check/finding.hpp"

namespace hapticd::device_check {

struct Outcome {
  const char* name;  ///< of the test
  Finding found;
};

struct Test {
  const char* name;
  Finding (*run)(const scene::Device& device);  ///< in a child process
};

/// All tests, in the order in which they run.
const std::vector<Test>& tests();

/// [main] Runs one in a child process of its own. A crash or a hang names the call in which it came, and ends the
/// examination.
Outcome tryOne(const Test& test, const scene::Device& device, int limit_ms);

}  // namespace hapticd::device_check
