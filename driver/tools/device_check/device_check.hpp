// SPDX-License-Identifier: MIT
/// The tests of a device module. They show the author of the module what is wrong, before a person holds the arm.
#pragma once
#include <vector>

#include "description/scene.hpp"
#include "device_check/finding.hpp"

namespace hapticd::device_check {

struct Outcome {
  const char* name;  ///< name of the test
  Finding found;
};

struct Test {
  const char* name;
  Finding (*run)(const scene::Device& device);  ///< in a child process
};

/// All tests, in the order in which they run.
const std::vector<Test>& tests();

/// [main] Runs one test in a child process of its own. If it crashes or hangs, the outcome names the call in which this
/// happened, and no further test is run.
Outcome tryOne(const Test& test, const scene::Device& device, int limit_ms);

}  // namespace hapticd::device_check
