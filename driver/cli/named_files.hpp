// SPDX-License-Identifier: MIT
/// The files that a scene names, opened with the rights of whoever asks, to be passed to a running daemon: it opens
/// none of them by name.
#pragma once
#include <string>
#include <vector>

#include "base/descriptors.hpp"
#include "base/result.hpp"

namespace hapticd::cli {

struct NamedFiles {
  std::vector<std::string> names;  ///< absolute
  std::vector<Descriptor> descriptors;
  std::vector<int> numbers() const;
};

/// [main] The scene first, then each regular file whose name is one of its values, or one of the values of a device
/// file that it names. Which of them are meant is for the daemon to say, which knows the plugins. @param scene absolute
/// path
Result<NamedFiles> openNamed(const std::string& scene);

}  // namespace hapticd::cli
