// SPDX-License-Identifier: MIT
/// Opens the files that a scene names with the rights of the caller, to pass them to a running daemon. The daemon opens
/// none of them by name.
#pragma once
#include <string>
#include <vector>

#include "base/descriptors.hpp"
#include "base/result.hpp"

namespace hapticd::cli {

struct NamedFiles {
  std::vector<std::string> names;  ///< absolute paths
  std::vector<Descriptor> descriptors;
  std::vector<int> numbers() const;
};

/// [main] Opens the scene, and then each regular file whose name is a value in the scene or in a device file that the
/// scene names. Only the daemon, which knows the plugins, decides which of these values are meant as files. @param
/// scene absolute path
Result<NamedFiles> openNamed(const std::string& scene);

}  // namespace hapticd::cli
