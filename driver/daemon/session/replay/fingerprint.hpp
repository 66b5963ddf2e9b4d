// SPDX-License-Identifier: MIT
/// Fingerprints of the files on which forces depend, by which a replay finds those that have changed.
#pragma once
#include <string>
#include <vector>

#include "description/scene.hpp"

namespace hapticd::servo {

/// A file on which forces depend, with its fingerprint during the run.
struct Fingerprint {
  std::string path, hash;
};

/// [main] Returns the FNV-1a hash of a file's bytes in hexadecimal, or "" if the file cannot be read.
std::string fingerprint(const std::string& file);

/// [main] Lists the files on which the forces of a model depend: its plugin, and those that its parameters name.
std::vector<std::string> filesOf(const scene::Model& model);

}  // namespace hapticd::servo
