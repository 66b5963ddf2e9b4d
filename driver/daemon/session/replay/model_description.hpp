// SPDX-License-Identifier: MIT
/// The text by which a recording describes a model that comes during the run: the model as in `about.scene.models`, the
/// version of its plugin, and fingerprints of its files, so that a replay can build the model.
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"
#include "description/scene.hpp"
#include "hapticd/shape.h"
#include "session/replay/fingerprint.hpp"

namespace hapticd::servo {

struct ModelDescription {
  scene::Model model;
  std::vector<Fingerprint> files;
  bool whole = false;  ///< false: it has no fingerprints, and perhaps neither path nor parameters
};

/// [any] Returns JSON in the characters of ASCII, so that it can be cut anywhere. If it would have more than `most`
/// bytes, it has no fingerprints and no path; if that is still too much, no parameters either.
/// @param readable the same model, with the paths under which this process can read its files
std::string describeModel(const scene::Model& model, const scene::Model& readable, const hsp_class& plugin,
                          size_t most);

/// [main] Reads what describeModel() has written.
Result<ModelDescription> readModelDescription(const std::string& json_text);

}  // namespace hapticd::servo
