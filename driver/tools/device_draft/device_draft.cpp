// SPDX-License-Identifier: MIT
#include "device_draft/device_draft.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace hapticd::device_draft {

double DeviceDraft::ofJoint(const std::vector<double>& list, int joint) {
  return list[list.size() == 1 ? 0 : static_cast<size_t>(joint)];
}

bool DeviceDraft::isPlanar() const {
  const auto straight = [](double twist) { return std::abs(std::sin(twist)) < 1e-6; };
  return kind == "chain" && joints > 1 && std::all_of(twists.begin(), twists.end(), straight);
}

bool DeviceDraft::isNameUsable() const {
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-') return false;
  return !name.empty() && name.size() <= 40;
}

}  // namespace hapticd::device_draft
