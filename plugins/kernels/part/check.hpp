// SPDX-License-Identifier: MIT
/// The rules that a part must keep before anything is computed from it.
#pragma once
#include <stdexcept>

#include "kernels/part/part.hpp"

namespace hapticd::brep {

/// An error in a part. Its text says which record is wrong, its value, and what was expected.
class PartError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// [main] Checks every index, range, kind and number of a part. A part that passes is safe to read, but its geometry
/// may still be poor.
/// @throws PartError that names the first record that breaks a rule.
void checkPart(const Part& part);

}  // namespace hapticd::brep
