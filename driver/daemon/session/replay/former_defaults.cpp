// SPDX-License-Identifier: MIT
#include "session/replay/former_defaults.hpp"

#include <algorithm>

#include "hapticd/abi.h"

namespace hapticd::servo {

namespace {

struct FormerDefault {
  const char* plugin_id;
  const char* version;  ///< the last version that had this default
  const char* id;
  uint32_t index;  ///< index of the parameter in the plugin's table
  double value;
};

/// Before version 1.1, contacts were not held: the nearest face was always felt.
constexpr FormerDefault kFormer[] = {
    {"org.hapticd.shape.nurbs_rigid", "1.0", "contact_hysteresis", 6, 0},
    {"org.hapticd.shape.pendulum", "1.0", "contact_hysteresis", 6, 0},
    {"org.hapticd.shape.push_button", "1.0", "contact_hysteresis", 6, 0},
};

/// True if the model is a part (a .hpart file): contacts of parts were always held.
bool isPart(const scene::Model& model) {
  return std::any_of(model.parameters.begin(), model.parameters.end(), [](const scene::Value& value) {
    return value.kind == HSP_PATH && std::filesystem::path(value.text).extension() == ".hpart";
  });
}

}  // namespace

void useFormerDefaults(scene::Model& model, const std::string& plugin_id, const std::string& version) {
  for (const FormerDefault& former : kFormer) {
    if (plugin_id != former.plugin_id || version != former.version || isPart(model)) continue;
    const auto given = [&former](const scene::Value& value) { return value.index == former.index; };
    if (std::any_of(model.parameters.begin(), model.parameters.end(), given)) continue;
    scene::Value& value = model.parameters.emplace_back();
    value.id = former.id;
    value.index = former.index;
    value.kind = HSP_REAL;
    value.number = former.value;
  }
}

}  // namespace hapticd::servo
