// SPDX-License-Identifier: MIT
/// Reads and sets the HDAPI's parameters, as numbers in the HDAPI's units.
#pragma once
#include "arm.hpp"
#include "scheduler.hpp"

namespace hapticd::hd {

constexpr int kMostNumbers = 16;

/// The arm, the frame and the scheduler from which a parameter is read.
struct Query {
  Arm& arm;
  const Frame& current;  ///< the frame that CURRENT_... means for the caller
  const Scheduler& scheduler;
};

/// Writes the numbers of a parameter. @return the number of values written, 0 if there is no such parameter, or -1 if
/// the parameter is a text
int numbersOf(const Query& asked, HDenum name, double out[kMostNumbers]);

/// Returns the text of a parameter, or nullptr if it is not a text.
const std::string* textOf(const DeviceFacts& facts, HDenum name);

/// Returns how many numbers a call needs to set a parameter, or 0 if it cannot be set.
int numbersToSet(HDenum name);
/// Sets a parameter. @return HD_SUCCESS, or the error
HDerror set(Arm& arm, HDenum name, const double* numbers);

}  // namespace hapticd::hd
