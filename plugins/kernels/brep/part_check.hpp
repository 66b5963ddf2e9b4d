// SPDX-License-Identifier: MIT
/// The rules that a part must keep before anything is computed from it.
#pragma once
#include <stdexcept>

#include "kernels/brep/part.hpp"

namespace hapticd::brep {

/// What is wrong with a part, in words for the user: which record, its value, and what was expected.
class PartError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// [main] Checks every index, range, kind and number. What passes is safe to read; it may still be poor geometry.
/// @throws PartError that names the first record that breaks a rule.
void checkPart(const Part& part);

}  // namespace hapticd::brep
