// SPDX-License-Identifier: MIT
/// The conformance tests that a shape plugin must pass, by name.
#pragma once
#include <string>
#include <vector>

#include "conformance/conformance_subject.hpp"

namespace hapticd::conformance {

struct ConformanceTest {
  const char* name;
  const char* doc;
  /// "": passed; "skip: why": does not apply; "warn: what": passed with a remark; "note: what": passed, and what was
  /// measured; otherwise what was wrong.
  std::string (*run)(const Recipe& recipe, uint64_t seed);
  const char* needs = nullptr;  ///< the test that must succeed, because otherwise this one only repeats its failure
};

std::vector<ConformanceTest> lifeTests();     ///< descriptors, parameters, creation and activation
std::vector<ConformanceTest> costTests();     ///< what a step may cost: time, memory, locks, system calls
std::vector<ConformanceTest> stepTests();     ///< what every step must give: finite and continuous answers
std::vector<ConformanceTest> contactTests();  ///< what a shape must give where it is touched
std::vector<ConformanceTest> memoryTests();   ///< what an instance must remember, and what it must not

/// All tests, in the order in which they run.
const std::vector<ConformanceTest>& conformanceTests();

/// Random parameters, probes, jumps, resets and bad samples from one seed. "" if nothing was wrong.
std::string fuzzOnce(const Recipe& recipe, uint64_t seed);

}  // namespace hapticd::conformance
