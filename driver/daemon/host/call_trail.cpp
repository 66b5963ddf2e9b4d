// SPDX-License-Identifier: MIT
#include "host/call_trail.hpp"

namespace hapticd::host {

static Trail* followed = nullptr;

void followCalls(Trail* trail) noexcept {
  followed = trail;
}

void tellCall(const char* name) noexcept {
  if (followed != nullptr) followed->mark(0, name);
}

}  // namespace hapticd::host
