// SPDX-License-Identifier: MIT
#include "library.hpp"

namespace hapticd::hd {

Library& library() {
  static auto& it = *new Library;
  return it;
}

Arm* Library::currentArm() {
  Arm* arm = find(current);
  if (arm == nullptr) errors.push(HD_INVALID_OPERATION, HD_INVALID_HANDLE);
  return arm;
}

double Library::rate() const {
  constexpr double kUsual = 1000;
  for (const Arm& arm : arms_)
    if (arm.isOpen()) return arm.facts().rate;
  return kUsual;
}

}  // namespace hapticd::hd
