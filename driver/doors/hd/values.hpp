// SPDX-License-Identifier: MIT
/// What the HDAPI calls parameters, as numbers in its own units.
#pragma once
#include "arm.hpp"
#include "scheduler.hpp"

namespace hapticd::hd {

constexpr int kMostNumbers = 16;

/// The arm and frame that are asked for a parameter.
struct Asked {
  Arm& arm;
  const Frame& current;  ///< what CURRENT_... means for the caller
  const Scheduler& scheduler;
};

/// @return how many numbers `out` got; 0: there is no such parameter, -1: it is a text
int numbersOf(const Asked& asked, HDenum name, double out[kMostNumbers]);

/// nullptr if it is not a text.
const std::string* textOf(const Facts& facts, HDenum name);

/// How many numbers a call to set it takes; 0 if it cannot be set.
int numbersToSet(HDenum name);
/// @return HD_SUCCESS, or the reason why not
HDerror set(Arm& arm, HDenum name, const double* numbers);

}  // namespace hapticd::hd
