// SPDX-License-Identifier: MIT
#include "diagnostics/device/rest_joints.hpp"

#include <algorithm>

#include "diagnostics/reading/given_values.hpp"

namespace hapticd::diagnostics {

using document::Node;

void keepWithinStops(const Node& root, Joints& q, uint32_t joints) {
  const Node *rows = find(root, {"parameters", "arm", "limits"}), *kind = find(root, {"parameters", "arm", "kind"});
  const Node* module = find(root, {"module"});
  if (rows == nullptr || !rows->isSequence() || rows->items.size() != joints) return;
  const bool middle = module != nullptr && module->scalar == "simulated" && kind != nullptr && kind->scalar == "chain";
  for (size_t i = 0; i < joints && i < q.size(); ++i) {
    const Node& row = rows->items[i];
    if (!row.isSequence() || row.items.size() != 2) continue;
    const auto low = document::toNumber(row.items[0].scalar), high = document::toNumber(row.items[1].scalar);
    if (low && high && *low < *high) q[i] = middle ? (*low + *high) / 2 : std::clamp(q[i], *low, *high);
  }
}

Joints restJoints(const Node& root, uint32_t joints) {
  Joints q{};
  const Node* pose = find(root, {"parameters", "calibration", "pose"});
  if (pose == nullptr || !pose->isSequence() || pose->items.size() != joints) {
    keepWithinStops(root, q, joints);
    return q;
  }
  for (size_t i = 0; i < joints && i < q.size(); ++i) q[i] = document::toNumber(pose->items[i].scalar).value_or(0);
  return q;
}

}  // namespace hapticd::diagnostics
