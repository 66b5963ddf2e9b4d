// SPDX-License-Identifier: MIT
/// Reads the first bytes of a file, which tell what kind of file it is before it is read as a whole.
#pragma once
#include <cstddef>
#include <string>

#include "base/result.hpp"

namespace hapticd {

/// [main] Returns the first bytes of a regular file: `count` of them, or fewer if the file is shorter. The errors are
/// those of openRegular().
Result<std::string> readBeginning(const std::string& file, size_t count);

}  // namespace hapticd
