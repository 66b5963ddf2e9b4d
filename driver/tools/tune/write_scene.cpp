// SPDX-License-Identifier: MIT
#include "tune/write_scene.hpp"

#include <yaml-cpp/yaml.h>

#include "base/regular_file.hpp"
#include "hapticd/abi.h"

namespace hapticd::tune {
namespace {

void writeModels(YAML::Node models, const Knob& knob, size_t value) {
  for (auto model : models)
    if (model["plugin"].as<std::string>("") == knob.plugin) {
      // Real numbers with all digits, so that the run uses what was measured.
      if (knob.kind == HSP_REAL)
        model["parameters"][knob.key] = knob.numbers[value];
      else if (knob.kind == HSP_ARRAY)
        model["parameters"][knob.key] = YAML::Load(knob.values[value]);
      else
        model["parameters"][knob.key] = knob.values[value];
    }
}

}  // namespace

Result<void> writeScene(const Findings& findings, const std::string& from, const std::string& to) {
  const Candidate& chosen = findings.tuning.candidates[findings.tuning.chosen];
  YAML::Emitter out;
  try {
    YAML::Node scene = YAML::LoadFile(from);
    for (size_t i = 0; i < findings.knobs.size(); ++i) {
      const Knob& knob = findings.knobs[i];
      if (chosen.choice[i] == knob.current) continue;
      writeModels(scene["models"], knob, chosen.choice[i]);
    }
    out.SetDoublePrecision(17);
    out << scene;
  } catch (const YAML::Exception& e) {
    return Error{from + ": " + e.what()};
  }
  return writeWhole(to, "# Made by `hapticd tune` from " + findings.scene + ", measured over " + findings.motion +
                            ".\n# Chosen: " + nameOf(findings, chosen) + ":\n# " + reason(findings) + ".\n" +
                            out.c_str() + "\n");
}

}  // namespace hapticd::tune
