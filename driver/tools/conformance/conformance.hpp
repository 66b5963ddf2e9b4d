// SPDX-License-Identifier: MIT
/// The conformance tests that a shape plugin must pass, by name.
#pragma once
#include <string>
#include <vector>

#include "conformance/subject.hpp"
#include "conformance/verdict.hpp"

namespace hapticd::conformance {

struct ConformanceTest {
  const char* name;
  const char* doc;
  Verdict (*run)(const Recipe& recipe, uint64_t seed);
  const char* needs = nullptr;  ///< test that must pass first, because this one would only repeat its failure
};

std::vector<ConformanceTest> lifeTests();     ///< descriptors, parameters, creation and activation
std::vector<ConformanceTest> costTests();     ///< what a step may cost: time, memory, locks, system calls
std::vector<ConformanceTest> stepTests();     ///< what every step must give: finite and continuous answers
std::vector<ConformanceTest> contactTests();  ///< what a shape must give where it is touched
std::vector<ConformanceTest> memoryTests();   ///< what an instance must remember, and what it must not

/// All tests, in the order in which they run.
const std::vector<ConformanceTest>& conformanceTests();

/// Tests one instance with random parameters, probes, jumps, resets and bad samples from one seed. Returns "" if
/// nothing was wrong.
std::string fuzzOnce(const Recipe& recipe, uint64_t seed);

}  // namespace hapticd::conformance
