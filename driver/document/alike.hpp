// SPDX-License-Identifier: MIT
/// Tells a problem of many equal models once.
#pragma once
#include "document/problem.hpp"

namespace hapticd::document {

/// Returns the problems without those that say the same of another item of a list, such as of models[7] in place of
/// models[0], if there are more than three; the first one then says how many more there are. Two say the same if they
/// differ by names alone, and by no number.
Problems withoutAlike(const Problems& problems);

}  // namespace hapticd::document
